#include "firmware/unicore/settings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/core/number_text.hpp"
#include "base/core/words.hpp"
#include "base/geo/geodetic.hpp"
#include "firmware/sentences/sentence_maker.hpp"

namespace skyloop::firmware {
namespace {

// In the order in which they leave (capture nmea-default.jsonl of jclark/satpulse for the first six). The last ones are
// those that any board can be given.
constexpr std::array<std::string_view, 17> unicore_sentences{"RMC", "GGA", "GLL", "GSA", "GSV", "VTG",
                                                             "GST", "ZDA", "THS", "HDT", "ROT", "GNS",
                                                             "GBS", "GRS", "DTM", "VLW", "HDG"};
struct OwnLog {
    std::string_view asked, name;
    bool text, binary, heading;
};
constexpr std::array<OwnLog, 8> own_logs{{{"VERSION", "VERSION", true, true, false},
                                          {"BESTNAV", "BESTNAV", true, true, false},
                                          {"RECTIME", "RECTIME", true, true, false},
                                          {"AGRIC", "AGRIC", true, true, false},
                                          {"UNIAGRIC", "AGRIC", true, true, false},
                                          {"PVTSLN", "PVTSLN", true, false, false},
                                          {"UNIHEADING", "UNIHEADING", true, false, true},
                                          {"OBSVM", "OBSVM", true, true, false}}};
constexpr std::array<int, 17> unicore_rtcm{1005, 1006, 1033, 1074, 1077, 1084, 1087, 1094, 1097,
                                           1104, 1107, 1114, 1117, 1124, 1127, 1134, 1137};
constexpr std::size_t own_rank = 100, rtcm_rank = 200;

// Answers to CONFIG (Example18_CheckConfig.ino, and of a UM982 with SBAS and UNDULATION as rtkbase and ArduPilot set
// them). One word of a topic may be a setting of its own.
struct Topic {
    std::string_view name, value;
};
constexpr std::array<Topic, 18> factory_topics{{{"ANTENNA", "POWERON"},
                                                {"NMEAVERSION", "V411"},
                                                {"RTK TIMEOUT", "120"},
                                                {"RTK RELIABILITY", "3 1"},
                                                {"PPP TIMEOUT", "120"},
                                                {"DGPS TIMEOUT", "300"},
                                                {"RTCMB1CB2A", "ENABLE"},
                                                {"ANTENNADELTAHEN", "0.0000 0.0000 0.0000"},
                                                {"PPS", "ENABLE GPS POSITIVE 500000 1000 0 0"},
                                                {"SIGNALGROUP", "2"},
                                                {"ANTIJAM", "AUTO"},
                                                {"AGNSS", "DISABLE"},
                                                {"BASEOBSFILTER", "DISABLE"},
                                                {"LOGSEQ", "1"},
                                                {"SBAS", ""},
                                                {"UNDULATION", ""},
                                                {"HEADING", ""},
                                                {"PPP ENABLE", ""}}};

struct MaskWord {
    std::string_view word;
    Constellation system;
};
constexpr std::array<MaskWord, 6> mask_words{{{"GPS", Constellation::gps},
                                              {"GLO", Constellation::glonass},
                                              {"GAL", Constellation::galileo},
                                              {"BDS", Constellation::beidou},
                                              {"QZSS", Constellation::qzss},
                                              {"IRNSS", Constellation::navic}}};

std::optional<UnicoreLogKind> sentence_log(std::string_view name) {
    if (name.size() != 5 || (!name.starts_with("GP") && !name.starts_with("GN"))) return std::nullopt;
    const auto* const found = std::ranges::find(unicore_sentences, name.substr(2));
    if (found == unicore_sentences.end()) return std::nullopt;
    const auto rank = static_cast<std::size_t>(found - unicore_sentences.begin());
    return UnicoreLogKind{UnicoreForm::sentence, std::string(*found), *sentence_message(*found), rank};
}

std::optional<UnicoreLogKind> rtcm_log(std::string_view name) {
    if (!name.starts_with("RTCM")) return std::nullopt;
    const auto number = number_in<int>(name.substr(4));
    if (!number || std::ranges::find(unicore_rtcm, *number) == unicore_rtcm.end()) return std::nullopt;
    return UnicoreLogKind{UnicoreForm::rtcm,
                          std::string(name),
                          {class_rtcm, static_cast<std::uint8_t>(*number - 1000)},
                          rtcm_rank + static_cast<std::size_t>(*number - 1000)};
}

std::string joined(std::span<const std::string> words) { return fmt::format("{}", fmt::join(words, " ")); }

// "TIME 60 1": at least so long. What a receiver makes of the distance behind it is not known: it is taken.
std::optional<UnicoreMode> surveying(UnicoreMode mode, std::span<const std::string> words) {
    const auto seconds = words.size() > 1 ? number_in<double>(words[1]) : std::nullopt;
    if (!seconds || *seconds < 0 || *seconds > 86400 || words.size() > 3) return std::nullopt;
    if (words.size() == 3 && !number_in<double>(words[2])) return std::nullopt;
    constexpr double any_m = 1e6;
    mode.survey = SurveyLimits{Seconds(*seconds), Metres(any_m)};
    return mode;
}

// Metres from the centre of the Earth, or degrees and metres above the ellipsoid.
std::optional<UnicoreMode> standing(UnicoreMode mode, std::span<const std::string> words) {
    std::array<double, 3> numbers{};
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const auto number = number_in<double>(words[i]);
        if (!number) return std::nullopt;
        numbers[i] = *number;
    }
    constexpr double least_radius_m = 6.2e6, most_radius_m = 6.6e6, most_height_m = 30'000;
    const auto [x, y, z] = numbers;
    const double radius = std::hypot(x, y, z);
    if (radius > least_radius_m && radius < most_radius_m)
        mode.place = BasePlace{Position<Ecef>(x, y, z), Metres(0)};
    else if (std::abs(x) <= 90 && std::abs(y) <= 180 && std::abs(z) <= most_height_m)
        mode.place = BasePlace{to_ecef(Geodetic::degrees(x, y, z)), Metres(0)};
    else
        return std::nullopt;
    return mode;
}

std::optional<UnicoreMode> base_mode_of(UnicoreMode mode, std::span<const std::string> words) {
    constexpr int most_station = 4095;
    const bool numbered = words.size() == 4 || (words.size() > 1 && words[1] == "TIME");
    if (numbered) {
        const auto station = number_in<int>(words[0]);
        if (!station || *station < 0 || *station > most_station) return std::nullopt;
        mode.station = *station;
        words = words.subspan(1);
    }
    if (words.empty()) return mode;
    if (words[0] == "TIME") return surveying(mode, words);
    return words.size() == 3 ? standing(mode, words) : std::nullopt;
}

}  // namespace

bool has_two_antennas(const BoardProfile& board) { return board.identity.hardware == "UM982"; }

std::optional<UnicoreLogKind> unicore_log(const BoardProfile& board, std::string_view asked) {
    const std::string name = upper_case(asked);
    if (auto sentence = sentence_log(name)) return sentence;
    if (auto rtcm = rtcm_log(name)) return rtcm;
    if (name.empty()) return std::nullopt;
    const std::string_view stem = std::string_view(name).substr(0, name.size() - 1);
    const auto* const found = std::ranges::find(own_logs, stem, &OwnLog::asked);
    const bool text = name.back() == 'A', binary = name.back() == 'B';
    if (found == own_logs.end() || !((text && found->text) || (binary && found->binary))) return std::nullopt;
    if (found->heading && !has_two_antennas(board)) return std::nullopt;
    // Of one log in both forms the binary one comes first (capture bestnav-dual.jsonl).
    const auto rank = own_rank + 2 * static_cast<std::size_t>(found - own_logs.begin()) + (text ? 1 : 0);
    return UnicoreLogKind{text ? UnicoreForm::text : UnicoreForm::binary, std::string(found->name), {}, rank};
}

std::string_view com_name(PortId port) {
    switch (port) {
        case PortId::uart1:
            return "COM1";
        case PortId::uart2:
            return "COM2";
        case PortId::uart3:
            return "COM3";
        default:
            return {};
    }
}

std::optional<PortId> com_port(const BoardProfile& board, std::string_view word) {
    const std::string name = upper_case(word);
    for (const PortId port : board.ports)
        if (!com_name(port).empty() && com_name(port) == name) return port;
    return std::nullopt;
}

std::optional<UnicoreMode> unicore_mode(std::span<const std::string> words) {
    if (words.empty()) return std::nullopt;
    UnicoreMode mode;
    mode.words = joined(words);
    const std::string& kind = words[0];
    if (kind == "BASE") return base_mode_of(mode, words.subspan(1));
    if (kind == "MOVINGBASE" || kind == "HEADING" || kind == "HEADING2") return mode;
    if (kind != "ROVER") return std::nullopt;
    constexpr int automotive = 4, airborne_4g = 8;
    const std::string motion = words.size() > 1 ? words[1] : "";
    if (motion == "UAV") mode.dynamic_model = airborne_4g;
    if (motion == "AUTOMOTIVE") mode.dynamic_model = automotive;
    if (!motion.empty() && motion != "SURVEY" && !mode.dynamic_model) return std::nullopt;
    return mode;
}

std::optional<Constellation> masked_system(std::string_view word) {
    const auto* const found = std::ranges::find(mask_words, word, &MaskWord::word);
    return found == mask_words.end() ? std::nullopt : std::optional(found->system);
}

UnicoreSettings::UnicoreSettings(const BoardProfile& board) : mask_deg(board.elevation_mask.deg()) {
    for (const PortId port : board.ports)
        if (is_uart(port)) bauds[port] = board.baud;
    for (const Topic& topic : factory_topics)
        topics_[std::string(topic.name)] = topic.value;
}

void UnicoreSettings::add(const UnicoreLog& log) {
    remove(log.port, log.kind);
    logs.push_back(log);
    std::ranges::stable_sort(logs, {}, [](const UnicoreLog& one) { return one.kind.rank; });
}

void UnicoreSettings::remove(std::optional<PortId> port, const std::optional<UnicoreLogKind>& kind) {
    std::erase_if(logs, [&](const UnicoreLog& log) {
        return (!port || log.port == *port) && (!kind || (log.kind.name == kind->name && log.kind.form == kind->form));
    });
}

bool UnicoreSettings::set_topic(std::span<const std::string> words) {
    if (words.size() < 2) return false;
    if (const auto pair = topics_.find(words[0] + " " + words[1]); pair != topics_.end()) {
        if (words.size() > 2) pair->second = joined(words.subspan(2));
        return words.size() > 2;
    }
    const auto enabled = topics_.find(words[0] + " ENABLE");
    if (enabled != topics_.end() && words[1] == "DISABLE") {
        enabled->second.clear();
        return true;
    }
    const auto topic = topics_.find(words[0]);
    if (topic == topics_.end()) return false;
    topic->second = joined(words.subspan(1));
    return true;
}

std::vector<std::pair<std::string, std::string>> UnicoreSettings::topic_lines() const {
    std::vector<std::pair<std::string, std::string>> lines;
    for (const Topic& topic : factory_topics) {
        const std::string& value = topics_.at(std::string(topic.name));
        if (value.empty()) continue;
        lines.emplace_back(topic.name.substr(0, topic.name.find(' ')), fmt::format("CONFIG {} {}", topic.name, value));
    }
    for (const auto& [port, baud] : bauds)
        lines.emplace_back(com_name(port), fmt::format("CONFIG {} {}", com_name(port), baud));
    return lines;
}

std::optional<double> UnicoreSettings::topic_number(std::string_view topic) const {
    const auto found = topics_.find(std::string(topic));
    return found == topics_.end() ? std::nullopt : number_in<double>(found->second);
}

std::string UnicoreSettings::text(const UnicoreSettings& factory) const {
    std::string text;
    const auto lines = topic_lines(), usual = factory.topic_lines();
    for (const auto& line : lines)
        if (std::ranges::find(usual, line) == usual.end()) text += line.second + '\n';
    if (mode.words != factory.mode.words) text += fmt::format("MODE {}\n", mode.words);
    if (mask_deg != factory.mask_deg) text += fmt::format("MASK {}\n", mask_deg);
    if (least_cn0) text += fmt::format("MASK CN0 {}\n", *least_cn0);
    for (const MaskWord& known : mask_words)
        if (masked.contains(known.system)) text += fmt::format("MASK {}\n", known.word);
    if (logs == factory.logs) return text;
    text += "UNLOGALL\n";
    for (const UnicoreLog& log : logs)
        text += fmt::format("{} {} {}\n", log.name, com_name(log.port), static_cast<double>(log.period_ms) / 1000);
    return text;
}

std::optional<std::uint64_t> wanted_period_ms(const UnicoreSettings& settings) {
    constexpr std::uint64_t longest = 1000;
    std::uint64_t common = 0;
    for (const UnicoreLog& log : settings.logs)
        common = std::gcd(common, log.period_ms);
    return common == 0 ? std::nullopt : std::optional(std::gcd(common, longest));
}

}  // namespace skyloop::firmware
