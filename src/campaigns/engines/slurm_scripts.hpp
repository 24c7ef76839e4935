/// A campaign as a job array of Slurm.
#pragma once

#include <string>
#include <vector>

#include "base/core/result.hpp"
#include "campaigns/engines/engine_task.hpp"

namespace skyloop {

/// What a cluster's users choose.
struct SlurmSettings {
    std::string partition{};             ///< empty: the cluster's default
    std::string time_limit{};            ///< of a shard, as `sbatch --time` takes it; empty: the partition's
    std::vector<std::string> options{};  ///< of sbatch, as they are: `--account=lab`, `--exclude=node7`
    std::size_t processors = 1;          ///< of a shard
    std::size_t retries = 5;             ///< after a fault of the machine, by the shard itself
};

/// Batch scripts for sbatch.
struct SlurmScripts {
    std::string shards;  ///< an array with a task for each shard
    std::string gather;  ///< to be submitted with a dependency on the array
};

/// Where the scripts of a task, their logs and their exit codes are: OUT/slurm.
std::filesystem::path slurm_folder(const EngineTask& task);

/// A shard that ends with a fault of the machine is put back into the queue by its own script, `retries` times; one
/// whose time is nearly over stops at the end of a run and is put back as long as it got on. What became of a shard is
/// left as its exit code in OUT/slurm/exit/I, for whoever follows. Fails with `usage` where the task cannot be
/// (`check_task`) or an option is not one, or is the script's own.
Result<SlurmScripts> slurm_scripts(const EngineTask& task, const SlurmSettings& settings);

}  // namespace skyloop
