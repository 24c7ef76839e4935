/// Options of skyloop campaign.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "campaign_engines.hpp"
#include "campaigns/campaign/campaign_folder.hpp"
#include "messages.hpp"

namespace skyloop::host {

/// What was typed.
struct CampaignOptions {
    std::string scenario, out, key;
    std::optional<std::string> seeds, shard;
    std::vector<std::string> vary;
    std::optional<std::uint64_t> number, jobs;
    std::optional<double> run_limit_s;
    EngineOptions engine;
    std::string page;        // of the report; empty: in the campaign's folder
    std::string junit;       // of the report, for build servers; empty: none
    std::size_t worst = 10;  // runs that the report names for each metric
    Verbosity verbosity;
};

CampaignRequest campaign_request(const CampaignOptions& options);

/// Runs what is missing. Exit code: 0, 1 where runs have no result, 3 where one failed, 75 when it was stopped.
int run_campaign(const CampaignOptions& options);
/// Has an engine run what run_campaign() would. Exit code as far as it is known here.
int hand_over(const CampaignOptions& options, const OpenedCampaign& campaign, const Messages& messages);
/// Says that signals have stopped it. @return 75
int told_stopped(const Messages& messages);
/// Merges what is there and says what it is. Exit code as of run_campaign().
int tell_gathered(const Messages& messages, const std::filesystem::path& folder);

/// Adds skyloop campaign report.
void add_campaign_report_command(CLI::App& campaign, CampaignOptions& options);
/// Writes the page and the numbers, and says the main ones.
int report_campaign(const CampaignOptions& options);

}  // namespace skyloop::host
