#include "detail/navigation_block.hpp"

#include <algorithm>
#include <array>

namespace skyloop::rinex {
namespace {

struct BlockMessage {
    std::string_view systems;
    std::string_view name;
    NavigationMessage message;
};
constexpr std::array<BlockMessage, 7> block_messages{{
    {"GJI", "LNAV", NavigationMessage::lnav},
    {"E", "INAV", NavigationMessage::inav},
    {"E", "FNAV", NavigationMessage::fnav},
    {"C", "D1", NavigationMessage::d1},
    {"C", "D2", NavigationMessage::d2},
    {"R", "FDMA", NavigationMessage::fdma},
    {"S", "SBAS", NavigationMessage::sbas},
}};

// Field `index` of a block's body, counted from the first of four on each line; the epoch takes the first one's place.
std::optional<double> block_field(std::span<const Line> lines, std::size_t index) {
    if (index / 4 >= lines.size() || !lines[index / 4].text.starts_with(' ')) return std::nullopt;
    return real_field(columns(lines[index / 4].text, 4 + 19 * (index % 4), 19));
}

template <std::size_t count>
std::optional<std::array<double, count>> block_fields(std::span<const Line> lines) {
    std::array<double, count> values{};
    for (std::size_t i = 0; i < count; ++i) {
        const std::optional<double> value = block_field(lines, i + 1);
        if (!value) return std::nullopt;
        values[i] = *value;
    }
    return values;
}

std::optional<KlobucharCoefficients>& klobuchar_of(BroadcastIonosphere& ionosphere, Constellation constellation) {
    switch (constellation) {
        case Constellation::qzss:
            return ionosphere.qzss;
        case Constellation::beidou:
            return ionosphere.beidou;
        case Constellation::navic:
            return ionosphere.navic;
        default:
            return ionosphere.gps;
    }
}

}  // namespace

BlockHead block_head(std::string_view line) {
    const std::string_view sender = columns(line, 6, 3);
    return {trimmed(columns(line, 2, 4)), sender.empty() ? std::nullopt : constellation_from_letter(sender.front()),
            parse_satellite(sender), trimmed(columns(line, 10, 4))};
}

std::optional<NavigationMessage> message_of_block(const BlockHead& head) {
    if (head.type != "EPH" || !head.satellite) return std::nullopt;
    const char letter = rinex_letter(head.satellite->constellation);
    for (const BlockMessage& m : block_messages)
        if (m.name == head.message && m.systems.find(letter) != std::string_view::npos) return m.message;
    return std::nullopt;
}

bool is_read_ionosphere(const BlockHead& head) {
    if (head.type != "ION") return false;
    if (head.message == "IFNV") return head.system == Constellation::galileo;
    if (head.message == "D1D2") return head.system == Constellation::beidou;
    return head.message == "LNAV" && (head.system == Constellation::gps || head.system == Constellation::qzss ||
                                      head.system == Constellation::navic);
}

bool take_ionosphere(const BlockHead& head, std::span<const Line> lines, BroadcastIonosphere& ionosphere) {
    if (head.message == "IFNV") {
        const auto values = block_fields<3>(lines);
        if (values && !ionosphere.galileo && *values != std::array<double, 3>{}) ionosphere.galileo = *values;
        return values.has_value();
    }
    const auto v = block_fields<8>(lines);
    if (!v) return false;
    auto& target = klobuchar_of(ionosphere, *head.system);
    const KlobucharCoefficients told{{(*v)[0], (*v)[1], (*v)[2], (*v)[3]}, {(*v)[4], (*v)[5], (*v)[6], (*v)[7]}};
    if (!target && told != KlobucharCoefficients{}) target = told;
    return true;
}

std::optional<TimeSystemCorrection> read_time_offset(std::span<const Line> lines) {
    if (lines.size() < 2) return std::nullopt;
    const std::string_view type = trimmed(columns(lines[0].text, 24, 18));
    const auto tow = block_field(lines.subspan(1), 0);
    const auto a0 = block_field(lines.subspan(1), 1);
    const auto a1 = block_field(lines.subspan(1), 2);
    if (type.size() != 4 || !tow || !a0 || !a1) return std::nullopt;
    return TimeSystemCorrection{std::string(type), *a0, *a1, *tow, 0};
}

}  // namespace skyloop::rinex
