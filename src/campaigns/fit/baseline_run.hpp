/// The article's sensor model, run where and when a receiver stood.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "campaigns/fit/fit_run.hpp"
#include "study/analysis/statistics.hpp"

namespace skyloop::inline campaigns {

/// The two numbers of the model by which it is fitted to a place: the parts of the ionospheric and of the tropospheric
/// delay that enter the range error (MODELS.md D-09; model.baseline.iono_fraction and tropo_fraction).
struct BaselineFractions {
    double iono = 0, tropo = 0;
    /// Those of the presets.
    static BaselineFractions strict();
    static BaselineFractions calibrated();
};
/// The largest that the keys take.
inline constexpr double largest_fraction = 10;

/// A scenario of the model at 1 Hz, as `skyloop simulate` reads it. Files are named by absolute paths.
/// @param remarks lines of comment at its top, each with its "# " and end
std::string baseline_scenario(const FitConditions& conditions, const BaselineFractions& fractions,
                              std::string_view remarks = {});

/// Variances and covariance, over the used satellites of an epoch, of the delays that the fractions weigh, m².
struct DelaySpread {
    double iono = 0, tropo = 0, both = 0;
    /// σ²_uere with these fractions: none but those delays are in the range error where nothing is reflected.
    [[nodiscard]] double variance(const BaselineFractions& f) const {
        return f.iono * f.iono * iono + 2 * f.iono * f.tropo * both + f.tropo * f.tropo * tropo;
    }
};

/// What the model made of a scenario.
struct BaselineRun {
    BaselineFractions fractions;
    PositionErrors errors;             ///< about the truth
    std::vector<DelaySpread> spreads;  ///< one for each of the errors
    std::string navigation;            ///< what the orbits are
    std::vector<std::string> warnings;

    /// The horizontal radial error of the same run with other fractions, m: E = PDOP σ_uere scales each epoch's noise.
    [[nodiscard]] std::vector<double> horizontal_with(const BaselineFractions& other) const;
};

/// Runs baseline_scenario() to its end, on the virtual clock and without wires. Fails as the scenario's reader and
/// assemble() do, with `input` where the model has fewer than two fixes, and with `outside` where it was stopped.
Result<BaselineRun> run_baseline(const FitConditions& conditions, const BaselineFractions& fractions,
                                 const DataFolders& data, const FitWatch& watch = {});

}  // namespace skyloop::inline campaigns
