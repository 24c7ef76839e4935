#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/core/words.hpp"
#include "detail/shown_names.hpp"

namespace skyloop::inline campaigns {
namespace {

// C0, DEL and C1, which a terminal obeys, and the two that XML 1.0 does not have (section 2.2): U+FFFE, U+FFFF.
bool is_not_shown(std::string_view character) {
    const auto first = static_cast<unsigned char>(character[0]);
    if (character.size() == 1) return first < 0x20 || first == 0x7F;
    if (character == "\xEF\xBF\xBE" || character == "\xEF\xBF\xBF") return true;
    return first == 0xC2 && static_cast<unsigned char>(character[1]) < 0xA0;
}

}  // namespace

std::string shown_text(std::string_view text, std::size_t most) {
    std::string shown;
    for (std::size_t characters = 0; !text.empty(); ++characters) {
        if (characters == most) return shown + "…";
        const std::size_t length = utf8_length(text);
        if (length == 0 || is_not_shown(text.substr(0, length)))
            shown += '?';
        else
            shown += text.substr(0, length);
        text.remove_prefix(length == 0 ? 1 : length);
    }
    return shown;
}

namespace {

constexpr std::size_t longest_name = 80;

struct UnitSuffix {
    std::string_view suffix, unit;
};
// The ends of names that scenario keys and metrics have.
constexpr std::array<UnitSuffix, 25> unit_suffixes{{
    {"_m", "m"},        {"_km", "km"},   {"_mm", "mm"},   {"_s", "s"},       {"_ms", "ms"},
    {"_us", "µs"},      {"_ns", "ns"},   {"_h", "h"},     {"_mps", "m/s"},   {"_mps2", "m/s²"},
    {"_mps3", "m/s³"},  {"_deg", "°"},   {"_rad", "rad"}, {"_dps", "°/s"},   {"_db", "dB"},
    {"_dbhz", "dB-Hz"}, {"_dbw", "dBW"}, {"_hz", "Hz"},   {"_percent", "%"}, {"_ppm", "ppm"},
    {"_ppb", "ppb"},    {"_k", "K"},     {"_hpa", "hPa"}, {"_tecu", "TECU"}, {"_chips", "chips"},
}};

bool has_word(std::string_view name, std::string_view word) {
    for (std::size_t at = name.find(word); at != std::string_view::npos; at = name.find(word, at + 1)) {
        const bool starts = at == 0 || name[at - 1] == '_' || name[at - 1] == '.';
        const std::size_t end = at + word.size();
        if (starts && (end == name.size() || name[end] == '_' || name[end] == '.')) return true;
    }
    return false;
}

template <std::size_t n>
bool has_word_of(std::string_view name, const std::array<std::string_view, n>& words) {
    return std::any_of(words.begin(), words.end(), [&](std::string_view word) { return has_word(name, word); });
}

// Close to none or all one decimal says too little.
bool two_decimals(double share) { return (share > 0 && share < 0.01) || (share > 0.99 && share < 1); }

std::string percent_figure_text(double share, int decimals) {
    if (share <= 0) return "0";
    if (share >= 1) return "100";
    constexpr double shown_apart = 0.005;
    if (100 * share < shown_apart) return "< 0.01";
    if (100 * share > 100 - shown_apart) return "> 99.99";
    return fmt::format("{:.{}f}", 100 * share, decimals);
}

}  // namespace

MetricWords metric_words(std::string_view name) {
    MetricWords result;
    for (const UnitSuffix& known : unit_suffixes)
        if (name.size() > known.suffix.size() && name.ends_with(known.suffix)) {
            result.unit = known.unit;
            name.remove_suffix(known.suffix.size());
            break;
        }
    result.words = shown_text(name, longest_name);
    std::replace(result.words.begin(), result.words.end(), '_', ' ');
    return result;
}

WorstEnd worst_end_of(std::string_view name, bool has_negative) {
    constexpr std::array<std::string_view, 10> wanted{"fix",     "fixes",        "satellites", "cn0",    "used",
                                                      "visible", "availability", "available",  "margin", "agreement"};
    constexpr std::array<std::string_view, 12> unwanted{"error", "time", "ttff",    "lost", "outage", "outages",
                                                        "gap",   "age",  "without", "no",   "wrong",  "missing"};
    if (has_word_of(name, wanted) && !has_word_of(name, unwanted)) return WorstEnd::smallest;
    return has_negative ? WorstEnd::farthest_from_zero : WorstEnd::largest;
}

std::string verdict_name(const CampaignResults& results, const VerdictSummary& verdict) {
    return verdict.verdict ? shown_text(results.verdicts[*verdict.verdict].name, longest_name)
                           : std::string("all checks of a run");
}

std::optional<std::string> replay_command(const CampaignResults& results, const GatheredRun& run) {
    constexpr std::size_t longest_path = 4096;
    const std::string options = shell_quoted(results.options);
    for (const std::string& text : {results.scenario, options})
        if (shown_text(text, longest_path) != text) return std::nullopt;
    // Of a vehicle's run there is no replay: it was in real time.
    if (results.scenario.empty() || !results.vehicle.empty()) return std::nullopt;
    return fmt::format("skyloop campaign replay {}{}{} --number {} --out run-{}", shell_quoted_path(results.scenario),
                       options.empty() ? "" : " ", options, run.number, run.number);
}

std::string parameters_of(const CampaignResults& results, std::size_t run) {
    std::string text;
    for (const ReportedParameter& parameter : results.parameters)
        if (parameter.values[run]) text += (text.empty() ? "" : ", ") + parameter.name + " = " + *parameter.values[run];
    return text;
}

std::string failures_of(const CampaignResults& results, std::size_t run) {
    if (results.runs[run].status == RunStatus::error)
        return results.runs[run].error.empty() ? "came to no end" : "error: " + results.runs[run].error;
    std::string text;
    for (const ReportedVerdict& verdict : results.verdicts)
        if (verdict.passed[run] == false) {
            text += text.empty() ? "" : "; ";
            text += verdict.name;
            if (!verdict.details[run].empty()) text += ": " + verdict.details[run];
        }
    return text.empty() ? "failed" : text;
}

std::string figure_text(double value) {
    if (value == 0) return "0";
    constexpr double smallest_plain = 1e-4, largest_plain = 1e7;
    const double size = std::abs(value);
    if (size < smallest_plain || size >= largest_plain) return fmt::format("{:.3e}", value);
    if (value == std::round(value)) return fmt::format("{:.0f}", value);
    return fmt::format("{:.{}f}", value, std::clamp(3 - static_cast<int>(std::floor(std::log10(size))), 0, 7));
}

std::string percent_text(double share) { return percent_figure_text(share, two_decimals(share) ? 2 : 1) + " %"; }

std::string interval_text(const PercentileInterval& interval) {
    if (!interval.low && !interval.high) return "open";
    if (!interval.low) return "up to " + figure_text(*interval.high);
    if (!interval.high) return "from " + figure_text(*interval.low);
    return figure_text(*interval.low) + " … " + figure_text(*interval.high);
}

std::string percent_interval_text(const Interval& interval) {
    const int decimals = two_decimals(interval.low) || two_decimals(interval.high) ? 2 : 1;
    return percent_figure_text(interval.low, decimals) + " … " + percent_figure_text(interval.high, decimals) + " %";
}

std::string p_value_text(double p) {
    constexpr double smallest_told = 0.001;
    return p < smallest_told ? std::string("p < 0.001") : fmt::format("p = {:.3f}", p);
}

}  // namespace skyloop::inline campaigns
