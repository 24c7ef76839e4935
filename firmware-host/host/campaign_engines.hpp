/// `skyloop campaign … --engine`: the campaign is not run here but handed to a cluster.
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

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

}  // namespace skyloop::host
