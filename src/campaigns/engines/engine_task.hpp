/// What an engine (Slurm, Kubernetes, GNU parallel) is given to do: the shards of one campaign.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "base/core/result.hpp"
#include "campaigns/engines/engine_template.hpp"

namespace skyloop {

/// A campaign that is cut into shards. Each shard is one call of
/// `PROGRAM campaign SCENARIO OPTIONS --out OUT --shard I/SHARDS`, and its exit code is the whole answer: 0 done, 3
/// done with a failed verdict (a result), 2 a scenario or campaign that cannot be (no second try), 75 stopped half-way
/// (goes on when called again); any other is a fault of the machine (another try).
struct EngineTask {
    std::string name;                    ///< of the campaign, as the engine's lists of jobs show it
    std::filesystem::path program;       ///< skyloop, absolute
    std::filesystem::path scenario;      ///< absolute
    std::filesystem::path out;           ///< the campaign's folder, absolute; the same for whoever runs a shard
    std::vector<std::string> options{};  ///< the campaign's own, as they were given: `--seeds`, `1..100`
    std::size_t shards = 1;              ///< 1 to `max_shards`
    EngineTemplates templates{};         ///< the site's own
};

/// More than any engine takes in one array as it is configured by default (Slurm: MaxArraySize, 1001).
inline constexpr std::size_t max_shards = 100'000;

/// How many shards a campaign is cut into when nobody says: at least ten runs in each, since starting a shard costs
/// tens of milliseconds, and at most 1000, which Slurm's MaxArraySize allows where nobody raised it (slurm.conf(5)).
std::size_t default_shards(std::size_t runs);

/// Refuses what no engine could be given: no shard or too many, and paths or options with control characters, which
/// neither a line of a batch script nor a list of tasks can bear. The error has the code `usage`.
Result<void> check_task(const EngineTask& task);

/// The command of a shard but for its number: `… --shard` and `I/N` are to be added.
std::vector<std::string> shard_command(const EngineTask& task);

/// The command that merges what the shards left.
std::vector<std::string> gather_command(const EngineTask& task);

/// The name as engines take it: small letters, digits and single hyphens, at most 40 of them, "campaign" when none is
/// left.
std::string plain_name(const std::string& name);

}  // namespace skyloop
