#include <fmt/format.h>

#include <fstream>
#include <optional>
#include <string_view>

#include "skyloop/campaign_report/campaign_report.hpp"

namespace skyloop {
namespace {

// Whoever reads meets the old file or the whole new one.
std::optional<Error> replace_file(const std::filesystem::path& path, std::string_view content) {
    const auto refused = [&] { return Error{ErrorCode::outside, fmt::format("{}: cannot be written", path.string())}; };
    std::filesystem::path fresh = path;
    fresh += ".part";
    {
        std::ofstream stream(fresh, std::ios::binary | std::ios::trunc);
        stream.write(content.data(), static_cast<std::streamsize>(content.size()));
        stream.close();
        if (!stream) {
            std::error_code ignored;
            std::filesystem::remove(fresh, ignored);
            return refused();
        }
    }
    std::error_code reason;
    std::filesystem::rename(fresh, path, reason);
    if (!reason) return std::nullopt;
    std::error_code ignored;
    std::filesystem::remove(fresh, ignored);
    return refused();
}

}  // namespace

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
    if (auto error = replace_file(written.html, campaign_report_html(*results, summary))) return fail(*error);
    if (auto error = replace_file(written.json, campaign_report_json(*results, summary))) return fail(*error);
    written.text = campaign_report_text(*results, summary);
    return written;
}

}  // namespace skyloop
