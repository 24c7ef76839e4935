#include <fmt/format.h>

#include <system_error>

#include "base/core/replace_file.hpp"
#include "campaigns/campaign_report/campaign_report.hpp"

namespace skyloop {
namespace {

// What the campaign itself goes on with.
bool is_kept_by_campaign(const std::filesystem::path& file, const std::filesystem::path& folder) {
    std::error_code none;
    const auto inside = std::filesystem::weakly_canonical(file, none)
                            .lexically_relative(std::filesystem::weakly_canonical(folder, none));
    return inside == "campaign.json" || inside == "campaign.sqlite" || (!inside.empty() && *inside.begin() == "shards");
}

Result<void> check_targets(const std::filesystem::path& folder, const WrittenCampaignReport& report,
                           const std::filesystem::path& junit) {
    if (report.json == report.html)
        return fail(
            ErrorCode::usage,
            fmt::format("{}: a page does not end in .json; expected a name such as report.html", report.html.string()));
    if (junit == report.html || junit == report.json)
        return fail(ErrorCode::usage, fmt::format("--junit {}: is the page or its numbers; expected a name such as "
                                                  "junit.xml",
                                                  junit.string()));
    for (const std::filesystem::path* file : {&report.html, &report.json})
        if (is_kept_by_campaign(*file, folder))
            return fail(ErrorCode::usage, fmt::format("--out {}: {} is the campaign's own; expected a name such as "
                                                      "report.html",
                                                      report.html.string(), file->string()));
    if (!junit.empty() && is_kept_by_campaign(junit, folder))
        return fail(
            ErrorCode::usage,
            fmt::format("--junit {}: is the campaign's own; expected a name such as junit.xml", junit.string()));
    return {};
}

// Whether a part has added to its results since they were gathered.
bool is_outdated(const std::filesystem::path& database, const std::filesystem::path& shards) {
    std::error_code none;
    const auto gathered = std::filesystem::last_write_time(database, none);
    for (const auto& part : std::filesystem::directory_iterator(shards, none))
        if (part.last_write_time(none) > gathered) return true;
    return false;
}

}  // namespace

Result<WrittenCampaignReport> write_campaign_report(const std::filesystem::path& folder,
                                                    const CampaignReportOptions& options) {
    WrittenCampaignReport written;
    written.html = options.html.empty() ? folder / "report.html" : options.html;
    written.json = written.html;
    written.json.replace_extension(".json");
    if (const auto targets = check_targets(folder, written, options.junit); !targets) return fail(targets.error());
    written.outdated = is_outdated(folder / "campaign.sqlite", folder / "shards");
    const auto results = read_campaign_results(folder / "campaign.sqlite");
    if (!results) return fail(results.error());
    const CampaignSummary summary = summarise(*results, options.worst);
    if (const auto kept = replace_file(written.html, campaign_report_html(*results, summary)); !kept)
        return fail(kept.error());
    written.text = campaign_report_text(*results, summary);
    // Beside a device or a pipe there is no place for a second file.
    std::error_code none;
    if (!std::filesystem::is_regular_file(written.html, none))
        written.json.clear();
    else if (const auto kept = replace_file(written.json, campaign_report_json(*results, summary)); !kept)
        return fail(kept.error());
    if (!options.junit.empty())
        if (const auto kept = replace_file(options.junit, campaign_report_junit(*results, summary)); !kept)
            return fail(kept.error());
    return written;
}

}  // namespace skyloop
