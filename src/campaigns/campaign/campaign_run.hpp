/// One run of a campaign.
#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "base/core/result.hpp"
#include "base/core/watchdog_process.hpp"
#include "campaigns/campaign/campaign_plan.hpp"
#include "campaigns/campaign/shard_results.hpp"
#include "run/emulator/assembly.hpp"
#include "run/emulator/data_folders.hpp"
#include "run/scenario/scenario.hpp"

namespace skyloop::inline campaigns {

/// What becomes of a scenario in a campaign: of its wires scripted clients (client:NAME) stay, and in a run with a
/// vehicle the first receiver has a pty; what it tells other programs is left out. Fails with `usage` for what makes
/// runs depend on each other or on the time of day: a state file, a start that is now.
Result<Scenario> campaign_scenario(const Scenario& scenario);
/// How such a scenario is assembled: on the virtual clock, unless it has a vehicle.
RunMode campaign_mode(const Scenario& scenario);

/// Which columns the results of a campaign have. Fails with `usage` for a metric that is not known.
/// @param scenario the base, with its campaign
Result<ResultColumns> result_columns(const Scenario& scenario, const std::vector<std::string>& parameters);

/// What a run needs besides itself.
struct CampaignRunSetup {
    std::string text;            ///< of the scenario
    std::filesystem::path file;  ///< its name
    DataFolders data{};
    ResultColumns columns{};
    OrphanWatchdog* orphans = nullptr;  ///< ends vehicles and probes that this program leaves behind; null: nobody
};

/// Runs it to its end. A scenario that cannot be run with these values is a result too, "error", since it would be the
/// same again. Fails with `outside` for what may be better next time, and where `stop` became true.
Result<RunResult> run_of_campaign(const CampaignRunSetup& setup, const PlannedRun& run,
                                  const std::vector<ScenarioChange>& changes, const std::atomic<bool>& stop);

}  // namespace skyloop::inline campaigns
