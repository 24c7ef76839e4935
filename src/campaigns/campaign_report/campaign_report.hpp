/// What came of a campaign, as a page, as numbers and as words.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "base/core/result.hpp"
#include "campaigns/campaign_report/campaign_results.hpp"
#include "campaigns/campaign_report/campaign_summary.hpp"

namespace skyloop::inline campaigns {

struct CampaignReportOptions {
    std::filesystem::path html;     ///< empty: report.html in the campaign's folder
    std::size_t worst = 10;         ///< runs that each metric names
    std::filesystem::path junit{};  ///< for build servers; empty: none
};

struct WrittenCampaignReport {
    std::filesystem::path html;
    std::filesystem::path json;  ///< beside the page, with the ending .json; empty: the page is a device or a pipe
    std::string text;            ///< the same in words, for standard output
    bool outdated = false;       ///< results have come since they were gathered
};

/// Reads `folder`/campaign.sqlite and writes the page, the numbers and what is for build servers, each under another
/// name first. The same database gives the same bytes. Fails as read_campaign_results() does, with `usage` when the
/// page's own name ends in .json or one of them would take the place of another or of what the campaign goes on with,
/// and with `outside` when a file cannot be written.
Result<WrittenCampaignReport> write_campaign_report(const std::filesystem::path& folder,
                                                    const CampaignReportOptions& options);

/// One page that needs nothing else: no script, no network, pictures inside, light and dark by what the reader's system
/// prefers. It is XHTML as well. Texts of the database are escaped.
std::string campaign_report_html(const CampaignResults& results, const CampaignSummary& summary);

/// The numbers as JSON, with both kinds of interval of each rate and the replay command of each run that is named.
std::string campaign_report_json(const CampaignResults& results, const CampaignSummary& summary);

/// More runs than this are not told in a JUnit document: servers refuse large ones.
inline constexpr std::size_t most_junit_runs = 10'000;

/// A JUnit document, as build servers read it: a case per run, with the replay command of each that did not pass, and
/// one for what is missing. Beyond most_junit_runs those that failed go first; the property runs_left_out counts the
/// rest.
std::string campaign_report_junit(const CampaignResults& results, const CampaignSummary& summary);

/// The main figures in at most some dozens of lines.
std::string campaign_report_text(const CampaignResults& results, const CampaignSummary& summary);

}  // namespace skyloop::inline campaigns
