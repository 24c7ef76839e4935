#include "firmware/septentrio/settings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include "base/core/number_text.hpp"
#include "base/core/words.hpp"

namespace skyloop::firmware {
namespace {

std::string key_of(std::string_view name, std::string_view index) {
    return index.empty() ? std::string(name) : fmt::format("{}, {}", name, index);
}

bool is_angle(std::string_view text) {
    const auto degrees = number_in<int>(text);
    return degrees && *degrees >= -90 && *degrees <= 90;
}

// What a number can be, and with how many decimals it is told.
struct NumberRule {
    std::string_view group, argument;
    double least, most;
    int decimals;  // -1: as many as it needs
};
constexpr NumberRule number_rules[] = {
    {"StaticPosGeodetic", "Latitude", -90, 90, 9},   {"StaticPosGeodetic", "Longitude", -180, 180, 9},
    {"StaticPosGeodetic", "Altitude", -1e3, 3e4, 4}, {"StaticPosCartesian", "X", -8e6, 8e6, 4},
    {"StaticPosCartesian", "Y", -8e6, 8e6, 4},       {"StaticPosCartesian", "Z", -8e6, 8e6, 4},
    {"RTCMv3Interval", "Interval", 0.1, 600, -1},    {"RTCMv3Formatting", "ReferenceID", 0, 4095, 0},
    {"AntennaOffset", "DeltaE", -1e3, 1e3, 4},       {"AntennaOffset", "DeltaN", -1e3, 1e3, 4},
    {"AntennaOffset", "DeltaU", -1e3, 1e3, 4},       {"AntennaOffset", "SetupID", 0, 255, 0},
    {"PPSParameters", "Delay", -1e6, 1e6, 2},        {"PPSParameters", "MaxSyncAge", 0, 3600, 0},
    {"PPSParameters", "PulseWidth", 1e-3, 1e3, 6},
};

const NumberRule* rule_of(std::string_view group, std::string_view argument) {
    const auto* const found = std::find_if(std::begin(number_rules), std::end(number_rules), [&](const auto& rule) {
        return rule.group == group && rule.argument == argument;
    });
    return found == std::end(number_rules) ? nullptr : found;
}

// As it is told; nothing when it cannot be.
std::optional<std::string> checked_number(const NumberRule& rule, std::string_view text) {
    const auto value = number_in<double>(text);
    if (!value || !(*value >= rule.least && *value <= rule.most)) return std::nullopt;
    if (rule.decimals == 0 && !number_in<int>(text)) return std::nullopt;
    const double told = *value + 0.0;  // no zero with a minus
    return rule.decimals < 0 ? fmt::format("{}", told) : fmt::format("{:.{}f}", told, rule.decimals);
}

std::optional<std::string> spelled(WordKind kind, std::string_view word) {
    const auto known = known_word(kind, word);
    return known ? std::optional(std::string(*known)) : std::nullopt;
}

// The words that a value can have, where they are known here.
struct WordRule {
    std::string_view group, argument;  // group empty: of any
    WordKind kind;
};
constexpr WordRule word_rules[] = {
    {"COMSettings", "Rate", WordKind::line_speed},
    {"COMSettings", "DataBits", WordKind::data_bits},
    {"COMSettings", "Parity", WordKind::parity},
    {"COMSettings", "StopBits", WordKind::stop_bits},
    {"COMSettings", "FlowControl", WordKind::flow_control},
    {"DataInOut", "Input", WordKind::input},
    {"DataInOut", "Output", WordKind::output},
    {"DataInOut", "Show", WordKind::shown},
    {"NMEATalkerID", "TalkerID", WordKind::talker},
    {"PVTMode", "Mode", WordKind::pvt_mode},
    {"PVTMode", "RoverMode", WordKind::rover_mode},
    {"PVTMode", "StaticPosition", WordKind::place},
    {"", "Datum", WordKind::datum},
    {"RTCMv3Output", "Messages", WordKind::correction},
    {"RTCMv3Formatting", "Signals", WordKind::signal},
    {"NtpClient", "Mode", WordKind::on_off},
    {"ReceiverDynamics", "Level", WordKind::level},
    {"ReceiverDynamics", "Motion", WordKind::motion},
    {"SatelliteTracking", "Satellite", WordKind::system},
    {"SatelliteUsage", "Satellite", WordKind::system},
    {"SignalTracking", "Signal", WordKind::signal},
    {"SignalUsage", "PVT", WordKind::signal},
    {"SignalUsage", "NavData", WordKind::signal},
    {"HealthMask", "Mask", WordKind::on_off},
    {"PPSParameters", "Interval", WordKind::pulse_interval},
    {"PPSParameters", "Polarity", WordKind::polarity},
    {"PPSParameters", "TimeScale", WordKind::time_scale},
    {"EventParameters", "Polarity", WordKind::polarity},
    {"ResetReceiver", "Level", WordKind::reset_level},
    {"ResetReceiver", "EraseMemory", WordKind::erased_memory},
    {"CopyConfigFile", "Source", WordKind::configuration},
    {"CopyConfigFile", "Target", WordKind::kept_configuration},
    {"ManageDisk", "Disk", WordKind::disk},
    {"ManageDisk", "Action", WordKind::disk_action},
};

std::optional<WordKind> kind_of(std::string_view group, std::string_view argument) {
    const auto* const found = std::find_if(std::begin(word_rules), std::end(word_rules), [&](const WordRule& rule) {
        return (rule.group.empty() || rule.group == group) && rule.argument == argument;
    });
    return found == std::end(word_rules) ? std::nullopt : std::optional(found->kind);
}

// G05, S120: as the guide numbers satellites.
struct SatelliteNumbers {
    char letter;
    int least, most;
};
constexpr SatelliteNumbers satellite_numbers[] = {{'G', 1, 32}, {'R', 1, 30}, {'E', 1, 36}, {'S', 120, 158},
                                                  {'C', 1, 63}, {'J', 1, 10}, {'I', 1, 14}};

std::optional<std::string> spelled_satellite(std::string word) {
    if (word.size() != 3 && word.size() != 4) return std::nullopt;
    word.front() = upper_case(word.front());
    const auto number = number_in<int>(std::string_view(word).substr(1));
    const bool known = std::any_of(std::begin(satellite_numbers), std::end(satellite_numbers), [&](const auto& s) {
        return number && s.letter == word.front() && *number >= s.least && *number <= s.most;
    });
    return known ? std::optional(word) : std::nullopt;
}

// One word of a value in the maker's spelling; nothing when it cannot be. What is not known here is taken as it is.
std::optional<std::string> checked_word(std::string_view group, std::string_view argument, const std::string& word) {
    const bool outputs = group == "SBFOutput" || group == "NMEAOutput";
    if (outputs && argument == "Cd") return spelled(WordKind::port, word);
    if (outputs && argument == "Interval") return spelled(WordKind::interval, word);
    if (outputs && same_word(word, "none")) return "none";
    if (group == "NMEAOutput") return spelled(WordKind::sentence, word);
    if (group == "SBFOutput") {
        const auto block = spelled(WordKind::block, word);
        return block ? block : spelled(WordKind::block_group, word);
    }
    if (group == "ElevationMask" && !is_angle(word)) return std::nullopt;
    if (const NumberRule* rule = rule_of(group, argument)) return checked_number(*rule, word);
    const auto kind = kind_of(group, argument);
    if (!kind) return word;
    const auto known = spelled(*kind, word);
    return !known && kind == WordKind::system ? spelled_satellite(word) : known;
}

// MSM4 and its like stand for the messages of all systems, and are told as these.
std::string members_of(std::string_view group, const std::string& word) {
    if (group != "RTCMv3Output" || !word.starts_with("MSM")) return word;
    const char type = word.back();
    return fmt::format("RTCM107{0}+RTCM108{0}+RTCM109{0}+RTCM110{0}+RTCM111{0}+RTCM112{0}+RTCM113{0}", type);
}

// The list with what a + or - before its words adds or takes away. Without a sign before the first it is a new one.
std::optional<std::string> merged_list(std::string_view group, std::string_view argument, const std::string& before,
                                       std::string text) {
    std::vector<std::string> list;
    if (text.front() == '+' || text.front() == '-')
        list = split_words(before, '+');
    else
        text.insert(0, "+");
    std::erase(list, "none");
    for (std::size_t at = 0; at < text.size();) {
        const char sign = text[at];
        const std::size_t end = std::min(text.find_first_of("+-", at + 1), text.size());
        const auto word = checked_word(group, argument, split_words(text.substr(at + 1, end - at - 1), ',').front());
        if (!word || word->empty()) return std::nullopt;
        for (const std::string& member : split_words(members_of(group, *word), '+')) {
            std::erase(list, member);
            if (sign == '+' && member != "none") list.push_back(member);
        }
        at = end;
    }
    return list.empty() ? "none" : fmt::format("{}", fmt::join(list, "+"));
}

}  // namespace

std::string wrong_argument(std::string_view command, std::initializer_list<std::string_view> names,
                           const std::vector<std::string>& arguments) {
    const auto wrong = [&](std::string_view name) {
        return fmt::format("exe{}: Argument '{}' is invalid!", command, name);
    };
    if (arguments.size() > names.size()) return wrong(arguments[names.size()]);
    std::size_t i = 0;
    for (const std::string_view name : names) {
        const std::string given = i < arguments.size() ? arguments[i] : "";
        ++i;
        if (given.empty() && name == "EraseMemory") continue;
        for (const std::string& word : split_words(given, '+'))
            if (!checked_word(command, name, word)) return wrong(name);
    }
    return {};
}

std::vector<std::string> split_words(std::string_view text, char separator) {
    std::vector<std::string> words;
    for (std::size_t at = 0; at <= text.size();) {
        const std::size_t end = std::min(text.find(separator, at), text.size());
        std::string_view word = text.substr(at, end - at);
        word.remove_prefix(std::min(word.find_first_not_of(" \t"), word.size()));
        words.emplace_back(word.substr(0, word.find_last_not_of(" \t") + 1));  // quotation marks stay
        at = end + 1;
    }
    return words;
}

SeptentrioSettings::SeptentrioSettings() {
    for (const SettingGroup& group : setting_groups()) {
        const auto defaults = split_words(group.defaults, ',');
        for (const std::string& index : split_words(group.indices, ' '))
            values_[key_of(group.name, index)] = defaults;
    }
}

const std::vector<std::string>& SeptentrioSettings::values(std::string_view name, std::string_view index) const {
    static const std::vector<std::string> none;
    const auto found = values_.find(key_of(name, index));
    return found == values_.end() ? none : found->second;
}

// Those that a command names: one, all, or nothing for one that there is not.
std::vector<std::string> SeptentrioSettings::indices_of(const SettingGroup& group, std::string_view wanted) const {
    std::vector<std::string> found;
    for (const std::string& index : split_words(group.indices, ' '))
        for (const std::string& word : split_words(wanted, '+'))
            if (same_word(index, word) || same_word(word, "all")) found.push_back(index);
    return found;
}

SettingAnswer SeptentrioSettings::set(const SettingGroup& group, const std::vector<std::string>& arguments) {
    const bool indexed = !group.indices.empty();
    const std::vector<std::string> names = split_words(group.arguments, ' ');
    const auto wrong = [&](std::string_view argument) {
        return SettingAnswer{{}, fmt::format("{}: Argument '{}' is invalid!", group.name, argument)};
    };
    std::vector<std::string> indices{{}};
    if (indexed) indices = indices_of(group, arguments.empty() ? "" : arguments.front());
    if (indices.empty()) return wrong("Index");
    const std::size_t first = indexed ? 1 : 0;
    if (arguments.size() > names.size() + first) return wrong(arguments[names.size() + first]);
    Values after = values_;
    for (const std::string& index : indices) {
        std::vector<std::string>& values = after[key_of(group.name, index)];
        for (std::size_t i = first; i < arguments.size(); ++i) {
            if (arguments[i].empty()) continue;
            std::string name = names[i - first];
            const bool list = name.back() == '+';
            if (list) name.pop_back();
            std::string& value = values[i - first];
            const auto now = list ? merged_list(group.name, name, value, arguments[i])
                                  : checked_word(group.name, name, arguments[i]);
            if (!now) return wrong(name);
            value = *now;
        }
    }
    values_ = std::move(after);
    return get(group, indexed ? std::vector<std::string>{arguments.front()} : std::vector<std::string>{});
}

SettingAnswer SeptentrioSettings::get(const SettingGroup& group, const std::vector<std::string>& arguments) const {
    SettingAnswer answer;
    std::vector<std::string> indices{{}};
    if (!group.indices.empty())
        indices = indices_of(group, arguments.empty() || arguments.front().empty() ? "all" : arguments.front());
    if (indices.empty()) return {{}, fmt::format("{}: Argument 'Index' is invalid!", group.name)};
    for (const std::string& index : indices)
        answer.states.push_back(
            fmt::format("{}, {}", key_of(group.name, index), fmt::join(values(group.name, index), ", ")));
    return answer;
}

const SettingGroup& setting_group(std::string_view name) {
    return *std::find_if(setting_groups().begin(), setting_groups().end(),
                         [&](const SettingGroup& group) { return group.name == name; });
}

}  // namespace skyloop::firmware
