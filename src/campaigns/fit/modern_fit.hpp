/// Which surroundings, and which scale of each cause, make the modern model err as a receiver at rest did.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "base/core/result.hpp"
#include "campaigns/fit/modern_run.hpp"
#include "study/analysis/standing_log.hpp"

namespace skyloop::inline campaigns {

/// What the model is to be like.
struct FitTarget {
    FitFigures figures;
    SignalStrengthByElevation signals;  ///< empty: the log does not tell
    RunningStatistics satellites_used;  ///< none: the log does not tell
    bool placed = false;                ///< where the antenna was is known
};
FitTarget target_of(const StandingLog& log);

/// What is fitted, and what is given.
struct ModernFitRequest {
    FitConditions conditions;  ///< its seed is that of the scenario; more runs have the next ones
    FitReceiver receiver;
    std::optional<Surroundings> surroundings{};  ///< nothing: those in which one may stand are tried
};

/// Settings, and what the model made of them.
struct ModernTrial {
    ModernFitSettings settings;
    std::vector<ModernRun> runs;  ///< of each seed
    FitFigures figures;           ///< of all of them
    double misfit = 0;            ///< root mean square of the distances of all figures; 1: as two hours of one receiver
    double unlikeness = 0;        ///< the same where errors of another size throughout count little: of surroundings

    [[nodiscard]] SignalStrengthByElevation signals() const { return runs.front().signals; }
};

/// What was found.
struct ModernFit {
    ModernTrial before;              ///< the preset under an open sky
    ModernTrial after;               ///< the best that was run
    std::vector<ModernTrial> tried;  ///< surroundings with every scale 1, the best first; without their runs
};

/// How many runs fit_modern() makes at most.
std::size_t most_runs(const ModernFitRequest& request);

/// The fit. Surroundings are run with every scale 1; for the two whose errors are most like the log's but for their
/// size each cause is run with half of its size, and the scales with the least sum of squared distances, each scale's
/// own logarithm among them so that what the log tells nothing of stays 1, are found by Levenberg and Marquardt's
/// method (MINPACK, as in Eigen). That is done once more about what was found. All runs have the same random numbers.
/// Fails as run_modern() does.
Result<ModernFit> fit_modern(const ModernFitRequest& request, const FitTarget& target, const DataFolders& data,
                             const FitWatch& watch = {});

}  // namespace skyloop::inline campaigns
