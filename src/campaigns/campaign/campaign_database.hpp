/// All results of a campaign in one SQLite file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/core/result.hpp"

namespace skyloop::inline campaigns {

/// What was found while gathering.
struct GatheredCounts {
    std::uint64_t planned = 0, passed = 0, failed = 0, errors = 0;
    std::vector<std::uint64_t> missing{};                    ///< numbers of runs without a result
    std::uint64_t duplicates = 0;                            ///< rows beyond the first of a run, equal to it
    std::uint64_t foreign = 0;                               ///< rows of runs that are not in the plan
    std::map<std::string, std::uint64_t> failed_verdicts{};  ///< by name: how many runs failed it
    [[nodiscard]] std::uint64_t done() const { return passed + failed + errors; }
};

/// Merges the tables in DIR/shards into DIR/campaign.sqlite, which is replaced when it is whole. The same results give
/// the same bytes, whatever wrote them in whatever order. Tables, all ordered by the runs' numbers: meta(name, value);
/// run(key, number, seed, status); parameter(key, name, value); metric(key, name, value), units in the names;
/// verdict(key, name, passed, detail), passed null where it was not run; error(key, message).
/// Fails with `input` where a run has two results that differ, naming both places.
Result<GatheredCounts> gather_campaign(const std::filesystem::path& folder);

}  // namespace skyloop::inline campaigns
