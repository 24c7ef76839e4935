#include "wire/can/slcan_adapter.hpp"

#include <fmt/format.h>

namespace skyloop::inline wire {
namespace {

constexpr std::string_view done = "\r", refused = "\a";
constexpr std::uint64_t stamp_period_ms = 60'000;

bool is_digit_within(std::string_view text, char most) { return text.size() == 1 && text[0] >= '0' && text[0] <= most; }

}  // namespace

SlcanAdapter::Taken SlcanAdapter::take(ByteSpan bytes) {
    Taken taken;
    for (const std::string& line : lines_.feed(bytes))
        taken.answers += answer(line, taken.frames);
    return taken;
}

std::string SlcanAdapter::line_of(const CanFrame& frame, std::uint64_t time_ms) const {
    if (!open_) return {};
    std::string line = slcan_line(frame);
    if (stamps_) line.insert(line.size() - 1, fmt::format("{:04X}", time_ms % stamp_period_ms));
    return line;
}

std::string SlcanAdapter::open_channel(bool listens) {
    if (open_) return std::string(refused);
    open_ = true;
    listens_ = listens;
    return std::string(done);
}

std::string SlcanAdapter::send(std::string_view line, std::vector<CanFrame>& frames) const {
    const auto frame = parse_slcan_line(line);
    if (!frame || !open_ || listens_) return std::string(refused);
    frames.push_back(*frame);
    return frame->extended ? "Z\r" : "z\r";
}

std::string SlcanAdapter::answer(std::string_view line, std::vector<CanFrame>& frames) {
    if (line.empty()) return std::string(done);
    if (line.size() > SlcanLines::longest) return std::string(refused);
    const std::string_view rest = line.substr(1);
    const auto verdict = [](bool good) { return std::string(good ? done : refused); };
    switch (line[0]) {
        case 'T':
        case 't':
            return send(line, frames);
        case 'O':
        case 'L':
            return rest.empty() ? open_channel(line[0] == 'L') : std::string(refused);
        case 'C': {
            const bool was_open = open_;
            open_ = false;
            return verdict(was_open && rest.empty());
        }
        case 'S':
            return verdict(!open_ && is_digit_within(rest, '8'));
        case 's':
        case 'M':
        case 'm':
            return verdict(!open_ && !rest.empty());
        case 'Z':
            if (!is_digit_within(rest, '1')) return std::string(refused);
            stamps_ = rest == "1";
            return std::string(done);
        case 'V':
            return "V1013\r";
        case 'N':
            return "NSKYL\r";
        case 'F':
            return open_ ? "F00\r" : std::string(refused);
        case 'X':
        case 'Q':
        case 'W':
        case 'U':
            return verdict(is_digit_within(rest, '9'));
        default:
            return std::string(refused);
    }
}

}  // namespace skyloop::inline wire
