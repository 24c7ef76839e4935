/// A campaign's jobs in a Slurm: how they come there, and what became of them.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/core/result.hpp"
#include "base/core/units.hpp"
#include "campaigns/engines/engine_scripts.hpp"
#include "campaigns/engines/engine_task.hpp"

namespace skyloop::inline campaigns {

/// Numbers that Slurm gave.
struct SlurmJob {
    std::string shards;  ///< of the array
    std::string gather;
    std::size_t count = 1;  ///< of shards in the campaign, those included that this array does not have
};

/// How jobs are followed.
struct FollowOptions {
    Seconds between_looks{5};
    Seconds file_patience{20};     ///< how long a shard's file may take to be seen here when its task has ended
    Seconds squeue_patience{600};  ///< how long a Slurm may not answer
    std::size_t submissions = 3;   ///< of a shard that a machine lost; its own script's tries come on top
    std::size_t runs = 0;          ///< planned; 0: unknown
    std::function<bool()> stopped = [] { return false; };
    std::function<void(const std::string&)> say = [](const std::string&) {};
};

/// Writes OUT/slurm/campaign.sbatch and gather.sbatch.
Result<void> write_slurm_files(const EngineTask& task, const SlurmScripts& scripts);

/// Fails with `outside` where jobs of this campaign are still in the queue: they read its file and scripts. A folder
/// without jobs asks no Slurm.
Result<void> check_slurm_queue(const EngineTask& task);

/// Calls sbatch for the shards, all of them when `only` is empty, and for the gathering after them; leaves the numbers
/// in OUT/slurm/jobs. Fails with `outside` where sbatch refuses, or where jobs of this campaign are still in the queue,
/// since two would do the same runs.
Result<SlurmJob> submit_slurm(const EngineTask& task, const std::vector<std::size_t>& only = {});

/// The jobs that were submitted last; nothing when none were.
std::optional<SlurmJob> submitted_slurm(const EngineTask& task);

/// Follows the jobs, cut into as many shards as they were, until the results are gathered, and submits shards again
/// that a machine lost. Asks squeue alone, so it works where no accounting is kept. Leaving it changes nothing: the
/// jobs go on.
/// @return exit code: that of `campaign gather`; 2 when a shard said that the campaign cannot be; 75 when it was
/// stopped or
///         tasks were cancelled; 1 when shards were lost too often
Result<int> follow_slurm(const EngineTask& task, SlurmJob job, const FollowOptions& options);

}  // namespace skyloop::inline campaigns
