/// `skyloop campaign … --engine`: the campaign is not run here but handed to a cluster.
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "messages.hpp"

namespace skyloop::host {

/// What is asked of an engine.
struct EngineOptions {
    std::string engine;      ///< slurm, kubernetes, parallel; empty: none, the campaign is run here
    std::size_t shards = 0;  ///< 0: as many as suit the runs
    bool submit = false, follow = false, dry_run = false;
    std::string partition, time_limit;
    std::vector<std::string> sbatch_options;
    std::filesystem::path hosts;  ///< for parallel; empty: here alone
    std::string image, claim, name_space, memory = "512Mi";
    std::filesystem::path mount;
    std::size_t parallelism = 32;
};

/// The campaign that is handed over.
struct EngineCampaign {
    std::string name;
    std::filesystem::path scenario, out;  ///< as they were given
    std::vector<std::string> options{};   ///< the campaign's own, as they were given: `--seeds`, `1..100`
    std::size_t runs = 0;                 ///< planned
    std::size_t jobs = 1;                 ///< processors of a shard, where the engine gives more than one
};

/// Adds --engine and what belongs to it.
void add_engine_options(CLI::App& command, EngineOptions& options);

/// Writes what the engine needs into the campaign's folder; submits and follows where that was asked for.
/// @return the program's exit code
int hand_to_engine(const EngineOptions& options, const EngineCampaign& campaign, const Messages& messages);

}  // namespace skyloop::host
