#include <fmt/format.h>

#include "campaign_options.hpp"
#include "campaigns/campaign_report/campaign_report.hpp"
#include "run_options.hpp"

namespace skyloop::host {

void add_campaign_report_command(CLI::App& campaign, CampaignOptions& options) {
    CLI::App* report =
        campaign.add_subcommand("report", "Tell what came of a gathered campaign: a page, JSON and text");
    report->add_option("DIR", options.out, "The campaign's folder")->required();
    report->add_option("--out", options.page, "The page; default: report.html in that folder");
    report->add_option("--junit", options.junit, "Also a JUnit document for a build server: a case a run");
    report->add_option("--worst", options.worst, "Runs that each metric names")->check(CLI::Range(0, 10000));
    add_verbosity_options(*report, options.verbosity);
}

int report_campaign(const CampaignOptions& options) {
    const Messages messages(options.verbosity);
    const auto written = write_campaign_report(options.out, {options.page, options.worst, options.junit});
    if (!written) return messages.error(written.error());
    if (written->outdated)
        messages.warning(
            fmt::format("{}: results have come since they were gathered; skyloop campaign gather takes "
                        "them in",
                        options.out));
    fmt::print("{}", written->text);
    messages.info(fmt::format("page: {}{}{}", written->html.string(),
                              written->json.empty() ? "" : "; numbers: " + written->json.string(),
                              options.junit.empty() ? "" : "; JUnit: " + options.junit));
    return 0;
}

}  // namespace skyloop::host
