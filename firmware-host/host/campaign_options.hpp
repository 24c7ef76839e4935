/// Options of skyloop campaign.
/// `skyloop campaign … --engine`: the campaign is not run here but handed to a cluster.
#pragma once

#include <CLI/CLI.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "campaigns/campaign/campaign_folder.hpp"
#include "messages.hpp"

namespace skyloop::host {

/// What is asked of an engine.
struct EngineOptions {
    std::string name;        ///< slurm, kubernetes, parallel; empty: none, the campaign is run here
    std::size_t shards = 0;  ///< 0: as many as suit the runs
    bool submit = false, follow = false, dry_run = false;
    std::vector<std::string> templates;  ///< files of the site, in place of the engine's
    std::string partition, time_limit;
    std::vector<std::string> sbatch_options;
    std::filesystem::path hosts;  ///< for parallel; empty: here alone
    std::string image, claim, name_space, memory = "512Mi";
    std::filesystem::path mount;
    std::size_t parallelism = 32;
};

/// Adds --engine and what belongs to it.
void add_engine_options(CLI::App& command, EngineOptions& options);

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
