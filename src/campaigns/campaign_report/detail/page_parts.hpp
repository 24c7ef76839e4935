/// The parts of the page of a campaign.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "campaigns/campaign_report/campaign_results.hpp"
#include "campaigns/campaign_report/campaign_summary.hpp"

namespace skyloop::inline campaigns {

/// Text of the database or of our own, for the content of an element or an attribute.
std::string page_text(std::string_view text, std::size_t most = 200);

/// The first so many metrics have pictures; all have their numbers.
inline constexpr std::size_t most_pictured_metrics = 60;
/// The strongest so many effects of a metric or verdict have pictures.
inline constexpr std::size_t most_pictured_effects = 6;
/// The first so many failed runs are listed; report.json has all.
inline constexpr std::size_t most_listed_runs = 100;

/// A cell with a number, aligned to the right.
std::string number_cell(std::string_view text);
/// Rows of run number, seed, `value`, parameters and command.
std::string run_row(const CampaignResults& results, std::size_t run, const std::string& value);
/// The table around such rows.
std::string run_table(std::string_view value_heading, const std::string& rows);

/// The parameters whose pictures are drawn, the strongest effect first.
std::vector<std::size_t> pictured_effects(const std::vector<Effect>& effects);

std::string style_sheet();
std::string verdict_section(const CampaignResults& results, const CampaignSummary& summary);
std::string effect_section(const CampaignResults& results, const CampaignSummary& summary);
std::string metric_sections(const CampaignResults& results, const CampaignSummary& summary);
std::string rate_sections(const CampaignResults& results, const CampaignSummary& summary);
std::string failed_run_section(const CampaignResults& results, const CampaignSummary& summary);
/// How the figures were made.
std::string method_section(const CampaignSummary& summary);

/// How a metric depends on a parameter: boxes of levels, or dots of numbers.
std::string effect_picture(const CampaignResults& results, const CampaignSummary& summary, const MetricSummary& metric,
                           const Effect& effect);

}  // namespace skyloop::inline campaigns
