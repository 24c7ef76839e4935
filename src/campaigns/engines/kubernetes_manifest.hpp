/// A campaign as an Indexed Job of Kubernetes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "base/core/result.hpp"
#include "campaigns/engines/engine_task.hpp"

namespace skyloop {

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

}  // namespace skyloop
