#include "run/fault/known_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "base/core/words.hpp"
#include "firmware/septentrio/settings.hpp"
#include "receiver/protocol/ubx_messages.hpp"

namespace skyloop::inline run {
namespace {

struct CommandName {
    std::string_view mnemonic;
    std::string whole;
    bool sets = false;
};

constexpr std::string_view attention_command = "SSSSSSSSSS";

// Chapter 3 of the mosaic-X5 reference guide, as far as boards know it.
std::vector<CommandName> make_command_names() {
    std::vector<CommandName> names{{"gecm", "getEchoMessage"},
                                   {"eecm", "exeEchoMessage"},
                                   {"grc", "getReceiverCapabilities"},
                                   {"gri", "getReceiverInterface"},
                                   {"lif", "lstInternalFile"},
                                   {"login", "LogIn"},
                                   {"logout", "LogOut"},
                                   {"eccf", "exeCopyConfigFile", true},
                                   {"emd", "exeManageDisk"},
                                   {"erst", "exeResetReceiver"}};
    names.push_back({attention_command, std::string(attention_command)});
    for (const firmware::SettingGroup& group : firmware::setting_groups()) {
        names.push_back({group.set, fmt::format("set{}", group.name), true});
        names.push_back({group.get, fmt::format("get{}", group.name)});
    }
    return names;
}

const std::vector<CommandName>& command_names() {
    static const std::vector<CommandName> names = make_command_names();
    return names;
}

const CommandName* find_command_name(std::string_view word) {
    const auto& names = command_names();
    const auto found = std::find_if(names.begin(), names.end(), [word](const CommandName& name) {
        return firmware::same_word(name.mnemonic, word) || firmware::same_word(name.whole, word);
    });
    return found == names.end() ? nullptr : &*found;
}

}  // namespace

std::optional<std::string_view> command_mnemonic(std::string_view word) {
    const CommandName* name = find_command_name(word);
    return name == nullptr ? std::nullopt : std::optional(name->mnemonic);
}

std::optional<std::string> command_line_name(std::string_view line) {
    constexpr std::string_view blank = " \t";
    const std::size_t begin = line.find_first_not_of(blank);
    if (begin == std::string_view::npos || line[begin] == '#') return std::nullopt;
    const std::string_view text = line.substr(begin);
    const std::string_view word = text.substr(0, text.find_first_of(", \t"));
    if (word.size() >= attention_command.size() && word.find_first_not_of('S') == std::string_view::npos)
        return std::string(attention_command);
    return std::string(command_mnemonic(word).value_or(word));
}

bool begins_some_command(std::string_view prefix) {
    const auto& names = command_names();
    return std::any_of(names.begin(), names.end(),
                       [prefix](const CommandName& name) { return upper_case(name.mnemonic).starts_with(prefix); });
}

bool is_setting_command(std::string_view mnemonic) {
    const CommandName* name = find_command_name(mnemonic);
    return name != nullptr && name->sets;
}

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
// Sentences for which u-blox has no number.
constexpr std::string_view more_sentences[] = {"HDT"};

bool all_of(std::string_view text, bool (*is_right)(char)) {
    return !text.empty() && std::all_of(text.begin(), text.end(), is_right);
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter_or_digit(char c) { return is_digit(c) || (c >= 'A' && c <= 'Z'); }
bool is_hexadecimal(char c) { return is_digit(c) || (c >= 'A' && c <= 'F'); }

// A proprietary sentence by its address, which is P and its maker's three letters with what he likes behind them; of
// PUBX with the number that follows: "PUBX,41".
bool may_be_proprietary(std::string_view name) {
    constexpr std::string_view of_ublox = "PUBX,";
    if (name.starts_with(of_ublox))
        return name.size() == of_ublox.size() + 2 && all_of(name.substr(of_ublox.size()), is_digit);
    return name.starts_with('P') && name.size() >= 4 && name != "PUBX" && all_of(name, is_letter_or_digit);
}

bool may_be_numbered(std::string_view name) {
    if (name.starts_with("RTCM-")) return all_of(name.substr(5), is_digit) && name.size() <= 9;
    return name.size() == 9 && name.starts_with("UBX-") && name[6] == '-' &&
           all_of(name.substr(4, 2), is_hexadecimal) && all_of(name.substr(7), is_hexadecimal);
}

// What a dialogue calls by a name of its own: sentences by their formatters. Those of other classes are told by their
// addresses: PUBX,00 and not PUBX-00.
bool is_called_so(const UbxMessage& message) { return message.id.message_class <= 0xF0; }

std::vector<std::string_view> called_messages() {
    std::vector<std::string_view> names(std::begin(more_sentences), std::end(more_sentences));
    for (const UbxMessage& message : ubx_messages())
        if (is_called_so(message)) names.push_back(message.name);
    return names;
}

bool begins_some(std::string_view prefix) {
    if (prefix.empty() || prefix.starts_with("UBX-") || prefix.starts_with("RTCM-") || begins_some_command(prefix))
        return true;
    if (prefix.starts_with('P') && all_of(prefix.substr(0, prefix.find(',')), is_letter_or_digit)) return true;
    const auto begins = [&](std::string_view name) { return name.starts_with(prefix); };
    const std::vector<std::string_view> names = called_messages();
    return std::any_of(names.begin(), names.end(), begins) ||
           std::any_of(std::begin(whole_protocols), std::end(whole_protocols), begins);
}

bool may_be_message(std::string_view name) {
    if (name == "ANYTHING" || may_be_proprietary(name) || may_be_numbered(name) || command_mnemonic(name)) return true;
    const std::vector<std::string_view> names = called_messages();
    return std::find(names.begin(), names.end(), name) != names.end() ||
           std::find(std::begin(whole_protocols), std::end(whole_protocols), name) != std::end(whole_protocols);
}

}  // namespace

bool is_message_named(std::string_view name, std::string_view wanted) {
    const std::string large = upper_case(name), pattern = upper_case(wanted);
    if (pattern == "ANYTHING") return true;
    if (pattern.ends_with('*')) return large.starts_with(std::string_view(pattern).substr(0, pattern.size() - 1));
    return large == pattern || large == upper_case(command_mnemonic(wanted).value_or(wanted));
}

std::optional<std::string> message_name_mistake(std::string_view wanted) {
    const std::string name = upper_case(wanted);
    const bool possible =
        name.ends_with('*') ? begins_some(std::string_view(name).substr(0, name.size() - 1)) : may_be_message(name);
    if (possible) return std::nullopt;
    return fmt::format("'{}' is no message{}; expected a name like MON-VER, CFG-*, GGA, \"PUBX,41\" or UBX-0A-04",
                       wanted, did_you_mean(name, called_messages()));
}

std::optional<std::string> satellite_mistake(SatelliteId satellite) {
    const SatelliteNumbers numbers = satellite_numbers[static_cast<std::size_t>(satellite.constellation)];
    if (satellite.number >= numbers.first && satellite.number <= numbers.last) return std::nullopt;
    const char letter = rinex_letter(satellite.constellation);
    return fmt::format("'{}' is no satellite; expected {}{:02} to {}{:02} of {}", to_string(satellite), letter,
                       numbers.first, letter, numbers.last, constellation_title(satellite.constellation));
}

}  // namespace skyloop::inline run
