#include "base/core/can_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "base/core/number_text.hpp"

namespace skyloop::inline base {
namespace {

constexpr std::size_t extended_digits = 8, standard_digits = 3, stamp_digits = 4;
constexpr std::uint32_t most_extended = 0x1FFF'FFFF, most_standard = 0x7FF;

// Two digits a byte.
std::optional<CanFrame> frame_of(std::string_view id, bool extended, std::string_view digits) {
    const auto number = hexadecimal_number_in<std::uint32_t>(id);
    if (!number || digits.size() % 2 != 0 || digits.size() > 2 * CanFrame::most_bytes) return std::nullopt;
    Bytes bytes;
    for (std::size_t at = 0; at < digits.size(); at += 2) {
        const auto byte = hexadecimal_number_in<std::uint32_t>(digits.substr(at, 2));
        if (!byte) return std::nullopt;
        bytes.push_back(static_cast<std::uint8_t>(*byte));
    }
    return can_frame(*number, extended, bytes);
}

}  // namespace

std::optional<CanFrame> can_frame(std::uint32_t id, bool extended, ByteSpan bytes) {
    if (id > (extended ? most_extended : most_standard) || bytes.size() > CanFrame::most_bytes) return std::nullopt;
    CanFrame frame{id, extended, static_cast<std::uint8_t>(bytes.size())};
    std::copy(bytes.begin(), bytes.end(), frame.data.begin());
    return frame;
}

std::string slcan_line(const CanFrame& frame) {
    std::string line = frame.extended ? fmt::format("T{:08X}{}", frame.id, frame.size)
                                      : fmt::format("t{:03X}{}", frame.id, frame.size);
    for (const std::uint8_t byte : frame.bytes())
        fmt::format_to(std::back_inserter(line), "{:02X}", byte);
    return line + '\r';
}

std::optional<CanFrame> parse_slcan_line(std::string_view line) {
    if (line.empty() || (line[0] != 'T' && line[0] != 't')) return std::nullopt;
    const bool extended = line[0] == 'T';
    const std::size_t id_digits = extended ? extended_digits : standard_digits, head = 1 + id_digits + 1;
    if (line.size() < head) return std::nullopt;
    const char count = line[head - 1];
    if (count < '0' || count > '8') return std::nullopt;
    const std::size_t digits = 2 * static_cast<std::size_t>(count - '0');
    const bool whole = line.size() == head + digits;
    const bool stamped =
        line.size() == head + digits + stamp_digits && hexadecimal_number_in<std::uint32_t>(line.substr(head + digits));
    if (!whole && !stamped) return std::nullopt;
    return frame_of(line.substr(1, id_digits), extended, line.substr(head, digits));
}

std::optional<CanFrame> parse_candump_line(std::string_view line) {
    const std::size_t end_of_time = line.find(") ");
    if (line.empty() || line[0] != '(' || end_of_time == std::string_view::npos) return std::nullopt;
    std::string_view rest = line.substr(end_of_time + 2);
    const std::size_t end_of_name = rest.find(' ');
    if (end_of_name == 0 || end_of_name == std::string_view::npos) return std::nullopt;
    rest = rest.substr(end_of_name + 1);
    // Newer ones write the direction behind the frame.
    rest = rest.substr(0, rest.find_first_of(" \r\n"));
    const std::size_t hash = rest.find('#');
    if (hash != extended_digits && hash != standard_digits) return std::nullopt;
    return frame_of(rest.substr(0, hash), hash == extended_digits, rest.substr(hash + 1));
}

std::vector<std::string> SlcanLines::feed(ByteSpan bytes) {
    std::vector<std::string> lines;
    for (const std::uint8_t byte : bytes) {
        if (byte == '\r')
            lines.push_back(std::exchange(line_, {}));
        else if (byte != '\n' && line_.size() <= longest)
            line_.push_back(static_cast<char>(byte));
    }
    return lines;
}

}  // namespace skyloop::inline base
