/// What leader and workers of a campaign tell each other: JSON, a line each.
#pragma once

#include <atomic>
#include <iosfwd>
#include <string>
#include <string_view>

#include "base/core/result.hpp"
#include "campaigns/campaign/campaign_run.hpp"

namespace skyloop::inline campaigns {

/// What all runs have in common, the scenario's text among it: it does not change while a campaign runs.
std::string worker_greeting(const CampaignRunSetup& setup);
std::string worker_question(const PlannedRun& run, const std::vector<ScenarioChange>& changes);

/// The result that an answer holds, or why there is none. Fails with `outside` for an answer that is not understood.
Result<RunResult> worker_answer(std::string_view line, const ResultColumns& columns);

/// Does the runs that are asked for, until the input ends or `stop` is true. Fails with `outside` for a line that is
/// not understood.
/// @param data where the program's own data lies
/// @param orphans ends the programs of runs whose worker is killed; null: nobody does
Result<void> serve_runs(std::istream& questions, std::ostream& answers, const DataFolders& data,
                        const std::atomic<bool>& stop, OrphanWatchdog* orphans = nullptr);

}  // namespace skyloop::inline campaigns
