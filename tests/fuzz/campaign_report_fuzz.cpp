// Any bytes as the database of a campaign: one line of refusal, or a page and numbers that are the same each time.
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "campaigns/campaign_report/campaign_report.hpp"
#include "require.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace skyloop;
    // SQLite reads files only.
    static const std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("skyloop-fuzz-" + std::to_string(getpid()) + ".sqlite");
    std::ofstream(path, std::ios::binary | std::ios::trunc)
        .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
    const auto results = read_campaign_results(path);
    std::filesystem::remove(path);
    if (!results) {
        require(!results.error().message.empty());
        require(results.error().message.find('\n') == std::string::npos);
        return 0;
    }
    const CampaignSummary summary = summarise(*results, 3);
    require(summary.passed + summary.failed + summary.errors == results->runs.size());
    for (const VerdictSummary& verdict : summary.verdicts)
        require(verdict.rate.interval.low <= verdict.rate.interval.high);
    const std::string page = campaign_report_html(*results, summary);
    require(page.find("<script") == std::string::npos);
    require(page == campaign_report_html(*results, summarise(*results, 3)));
    require(!campaign_report_json(*results, summary).empty());
    require(!campaign_report_text(*results, summary).empty());
    return 0;
}
