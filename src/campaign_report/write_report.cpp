#include <fmt/format.h>

#include "skyloop/base/replace_file.hpp"
#include "skyloop/campaign_report/campaign_report.hpp"

namespace skyloop {

Result<WrittenCampaignReport> write_campaign_report(const std::filesystem::path& folder,
                                                    const CampaignReportOptions& options) {
    WrittenCampaignReport written;
    written.html = options.html.empty() ? folder / "report.html" : options.html;
    written.json = written.html;
    written.json.replace_extension(".json");
    if (written.json == written.html)
        return fail(ErrorCode::usage,
                    fmt::format("{}: a page does not end in .json; expected a name such as report.html",
                                written.html.string()));
    const auto results = read_campaign_results(folder / "campaign.sqlite");
    if (!results) return fail(results.error());
    const CampaignSummary summary = summarise(*results, options.worst);
    if (const auto kept = replace_file(written.html, campaign_report_html(*results, summary)); !kept)
        return fail(kept.error());
    if (const auto kept = replace_file(written.json, campaign_report_json(*results, summary)); !kept)
        return fail(kept.error());
    written.text = campaign_report_text(*results, summary);
    return written;
}

}  // namespace skyloop
