/// A campaign on a few machines, by GNU parallel over ssh.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "base/core/result.hpp"
#include "campaigns/engines/engine_task.hpp"

namespace skyloop {

/// What the owner of the machines chooses.
struct ParallelSettings {
    std::string
        hosts{};  ///< the text of a file as `parallel --sshloginfile` reads it: `[JOBS/]HOST` a line, `:` is here
    std::string scenario_text{};  ///< another text is another campaign, whose shards are all to be run
    std::size_t retries = 3;      ///< of a shard, after a fault of the machine; the next try is on another host
};

/// Scripts for sh, and where they belong.
struct ParallelScripts {
    std::string campaign;  ///< OUT/parallel/campaign.sh: runs all shards, then gathers
    std::string shard;     ///< OUT/parallel/shard.sh I
    std::string hosts;     ///< OUT/parallel/hosts
};

/// Where the scripts of a task are: OUT/parallel. All hosts see it, the program and the scenario under the same paths.
std::filesystem::path parallel_folder(const EngineTask& task);

/// `campaign.sh` keeps a log of the shards beside itself and does not repeat what ended well when it is called again
/// (`parallel --joblog --resume-failed`). Its exit code is that of `campaign gather`, 2 when the campaign cannot be,
/// 1 when shards failed, 75 when it was interrupted.
/// Fails with `usage` where the task cannot be, or the hosts' text names none.
Result<ParallelScripts> parallel_scripts(const EngineTask& task, const ParallelSettings& settings);

/// Writes them.
Result<void> write_parallel_files(const EngineTask& task, const ParallelScripts& scripts);

}  // namespace skyloop
