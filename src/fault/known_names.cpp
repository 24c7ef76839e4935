#include "skyloop/fault/known_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "skyloop/base/spelling.hpp"
#include "skyloop/protocol/ubx_names.hpp"

namespace skyloop {
namespace {

struct SatelliteNumbers {
    int first, last;
};
// That a system's signals can have, in the order of Constellation: the codes of IS-GPS-200 (1 to 63), the PRNs 120 to
// 158 of SBAS, the primary codes of Galileo's E1 (1 to 50), those of BeiDou's B1I (1 to 63), J01 to J10, 32 of GLONASS,
// of whose slots 24 are in use, and 14 of NavIC.
constexpr std::array<SatelliteNumbers, constellation_names.size()> satellite_numbers{
    {{1, 63}, {20, 58}, {1, 50}, {1, 63}, {1, 10}, {1, 32}, {1, 14}}};

constexpr std::string_view whole_protocols[] = {"UBX", "NMEA", "RTCM", "MSP", "MAVLINK", "SBF"};

std::string large_letters(std::string_view text) {
    std::string large(text);
    std::transform(large.begin(), large.end(), large.begin(),
                   [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
    return large;
}

bool all_of(std::string_view text, bool (*is_right)(char)) {
    return !text.empty() && std::all_of(text.begin(), text.end(), is_right);
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter_or_digit(char c) { return is_digit(c) || (c >= 'A' && c <= 'Z'); }
bool is_hexadecimal(char c) { return is_digit(c) || (c >= 'A' && c <= 'F'); }

// A sentence without its talker, or a proprietary one with what follows its address.
bool may_be_sentence(std::string_view name) {
    constexpr std::size_t longest_formatter = 5;
    const std::string_view address = name.substr(0, name.find(','));
    if (!all_of(address, is_letter_or_digit)) return false;
    if (address.front() == 'P') return true;
    return address == name && name.size() <= longest_formatter;
}

bool may_be_numbered(std::string_view name) {
    if (name.starts_with("RTCM-")) return all_of(name.substr(5), is_digit) && name.size() <= 9;
    return name.size() == 9 && name.starts_with("UBX-") && name[6] == '-' &&
           all_of(name.substr(4, 2), is_hexadecimal) && all_of(name.substr(7), is_hexadecimal);
}

// Sentences of other classes are told by their addresses: PUBX,00 and not PUBX-00.
bool is_frame(const UbxMessageName& message) { return message.id.message_class < 0xF0; }

bool begins_some(std::string_view prefix) {
    if (all_of(prefix, is_letter_or_digit) || prefix.starts_with("UBX-") || prefix.starts_with("RTCM-")) return true;
    if (prefix.starts_with("P") && prefix.find('-') == std::string_view::npos) return true;
    const auto names = ubx_message_names();
    return prefix.empty() || std::any_of(names.begin(), names.end(), [&](const UbxMessageName& message) {
               return is_frame(message) && message.name.starts_with(prefix);
           });
}

bool may_be_message(std::string_view name) {
    if (name == "ANYTHING" || may_be_sentence(name) || may_be_numbered(name)) return true;
    if (std::find(std::begin(whole_protocols), std::end(whole_protocols), name) != std::end(whole_protocols))
        return true;
    const auto names = ubx_message_names();
    return std::any_of(names.begin(), names.end(),
                       [&](const UbxMessageName& message) { return is_frame(message) && message.name == name; });
}

}  // namespace

bool is_message_named(std::string_view name, std::string_view wanted) {
    const std::string large = large_letters(name), pattern = large_letters(wanted);
    if (pattern == "ANYTHING") return true;
    if (pattern.ends_with('*')) return large.starts_with(std::string_view(pattern).substr(0, pattern.size() - 1));
    return large == pattern;
}

std::optional<std::string> message_name_mistake(std::string_view wanted) {
    const std::string name = large_letters(wanted);
    const bool possible =
        name.ends_with('*') ? begins_some(std::string_view(name).substr(0, name.size() - 1)) : may_be_message(name);
    if (possible) return std::nullopt;
    std::vector<std::string_view> known;
    for (const UbxMessageName& message : ubx_message_names())
        if (is_frame(message)) known.push_back(message.name);
    return fmt::format("'{}' is no message{}; expected a name like MON-VER, CFG-*, GGA, \"PUBX,41\" or UBX-0A-04",
                       wanted, did_you_mean(name, known));
}

std::optional<std::string> satellite_mistake(SatelliteId satellite) {
    const SatelliteNumbers numbers = satellite_numbers[static_cast<std::size_t>(satellite.constellation)];
    if (satellite.number >= numbers.first && satellite.number <= numbers.last) return std::nullopt;
    const char letter = rinex_letter(satellite.constellation);
    return fmt::format("'{}' is no satellite; expected {}{:02} to {}{:02} of {}", to_string(satellite), letter,
                       numbers.first, letter, numbers.last, constellation_title(satellite.constellation));
}

}  // namespace skyloop
