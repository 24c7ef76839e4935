// Writes the page of the campaign in a folder: campaign_report_page DIR [HTML].
#include <cstdio>

#include "skyloop/campaign_report/campaign_report.hpp"

int main(int argc, char** argv) {
    if (argc < 2) return 2;
    skyloop::CampaignReportOptions options;
    if (argc > 2) options.html = argv[2];
    const auto written = skyloop::write_campaign_report(argv[1], options);
    if (!written) {
        std::fprintf(stderr, "%s\n", written.error().message.c_str());
        return 1;
    }
    std::fputs(written->text.c_str(), stdout);
    return 0;
}
