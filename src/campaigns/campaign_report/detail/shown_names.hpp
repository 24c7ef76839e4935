/// Texts of a database as they are shown.
/// Names of metrics in words, and what is told of runs by name.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "campaigns/campaign_report/campaign_summary.hpp"

namespace skyloop::inline campaigns {

/// `text` on one line: control characters and what is not UTF-8 as '?', after `most` characters cut with "…".
std::string shown_text(std::string_view text, std::size_t most = 200);

struct MetricWords {
    std::string words;  ///< "horizontal error p95"
    std::string unit;   ///< as it is written, "m/s"; empty: none
    /// "horizontal error p95, m"
    [[nodiscard]] std::string axis() const { return unit.empty() ? words : words + ", " + unit; }
};

/// A name with its unit at the end, taken apart: "horizontal_error_p95_m".
MetricWords metric_words(std::string_view name);

/// The bad end of a metric by the words in its name: few fixes, satellites or signals are bad, and of all else much.
/// Nothing tells that a number with a sign is bad at one end only.
WorstEnd worst_end_of(std::string_view name, bool has_negative);

std::string verdict_name(const CampaignResults& results, const VerdictSummary& verdict);

/// The command that runs one run again, quoted for a shell; nothing for a run with a vehicle, and where a
/// quoted name would break the line.
std::optional<std::string> replay_command(const CampaignResults& results, const GatheredRun& run);

/// What a run was given: "noise = 0.5, board = ublox-m9"; its length has no bound.
std::string parameters_of(const CampaignResults& results, std::size_t run);
/// Why a run did not pass: the verdicts that it failed, with what they said, or its error; its length has no bound.
std::string failures_of(const CampaignResults& results, std::size_t run);

/// A number with four significant digits.
std::string figure_text(double value);
/// A share in percent; "100 %" and "0 %" only when it is.
std::string percent_text(double share);
/// "0.93 … 0.97", an open end in words.
std::string interval_text(const PercentileInterval& interval);
std::string percent_interval_text(const Interval& interval);
/// "p < 0.001" and the like.
std::string p_value_text(double p);

}  // namespace skyloop::inline campaigns
