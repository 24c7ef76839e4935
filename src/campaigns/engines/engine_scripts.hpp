/// A campaign as a job array of Slurm.
/// A campaign on a few machines, by GNU parallel over ssh.
/// A campaign as an Indexed Job of Kubernetes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/core/result.hpp"
#include "campaigns/engines/engine_task.hpp"

namespace skyloop::inline campaigns {

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

/// What a cluster's users choose.
struct KubernetesSettings {
    std::string image{};            ///< with `skyloop` in its PATH and a POSIX `sh`
    std::string claim{};            ///< the PersistentVolumeClaim that holds the scenario, its files and the results
    std::filesystem::path mount{};  ///< where the claim is mounted, in the containers and here; absolute
    std::string name_space{};       ///< empty: the one of whoever applies it
    std::string memory = "512Mi";   ///< that a container may use, as Kubernetes writes quantities
    std::size_t parallelism = 32;   ///< containers at a time
    std::size_t retries = 3;        ///< of a shard, after a fault of the machine
    std::uint32_t user = 0;         ///< number of who owns the results, as whom containers run; 0: as the image's user
    std::uint32_t group = 0;        ///< likewise of their group; counts only with a user
};

/// Manifests for kubectl.
struct KubernetesManifests {
    std::string shards;  ///< a Job with an index for each shard
    std::string gather;  ///< a Job to be applied when that one is complete
};

/// The index of a container is its shard. Only fields of batch/v1 that Kubernetes 1.33 has as stable, and
/// podReplacementPolicy, stable in 1.34 and on by default since 1.29 (Job v1 batch, JobSpec).
/// Exit code 2 ends the whole Job, since all shards would say the same; 3 counts as success; a container that its node
/// lost or gave away is replaced without being counted as a try. Fails with `usage` where the task cannot be, a name is
/// none that Kubernetes takes, or the scenario or the results lie outside of the mount.
Result<KubernetesManifests> kubernetes_manifests(const EngineTask& task, const KubernetesSettings& settings);

}  // namespace skyloop::inline campaigns
