/// The modern model, run where and when a receiver stood.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "base/core/units.hpp"
#include "campaigns/fit/fit_figures.hpp"
#include "campaigns/fit/fit_run.hpp"
#include "run/scenario/modern_settings.hpp"
#include "study/analysis/fix_series.hpp"

namespace skyloop::inline campaigns {

/// Causes of error whose scales are fitted, as model.modern.terms names them. What the others do to a position at rest
/// is millimetres, or nothing.
inline constexpr std::array<std::string_view, 5> fitted_causes{"signal_in_space", "ionosphere", "multipath",
                                                               "code_noise", "channel"};
using CauseScales = std::array<double, fitted_causes.size()>;

/// The receiver, which is told and not fitted.
struct FitReceiver {
    ModernPreset preset = ModernPreset::consumer;
    std::string board{};                        ///< empty: the scenario's default
    std::vector<std::string> constellations{};  ///< empty: the board's
};

/// What is fitted.
struct ModernFitSettings {
    Surroundings surroundings = Surroundings::open_sky;
    Decibels weaker{0};  ///< that all signals are than with the preset's implementation loss
    CauseScales scales{1, 1, 1, 1, 1};
};

/// Whether the cause acts there: an open sky has no channel.
bool acts(std::size_t cause, Surroundings surroundings);

/// A scenario of the model at 1 Hz, as `skyloop simulate` reads it.
/// @param remarks lines of comment at its top, each with its "# " and end
std::string modern_scenario(const FitConditions& conditions, const FitReceiver& receiver,
                            const ModernFitSettings& settings, std::string_view remarks = {});

/// What the model made of a scenario.
struct ModernRun {
    std::vector<std::optional<Eigen::Vector3d>> enu;  ///< error of each epoch, m; nothing: it had no fix
    SignalStrengthByElevation signals;                ///< of what was tracked
    RunningStatistics satellites_used;
    FitRunNotes notes;

    /// Of all epochs with a fix, about the truth or, unless `placed`, about their mean.
    [[nodiscard]] PositionErrors errors(bool placed) const;
    [[nodiscard]] FixTimes times() const;
    [[nodiscard]] FitFigures figures(bool placed) const { return fit_figures(errors(placed), times(), placed); }
};

/// Runs modern_scenario() to its end, on the virtual clock and without wires. Fails as the scenario's reader and
/// assemble() do, with `input` where fewer than two epochs have a fix, and with `outside` where it was stopped.
Result<ModernRun> run_modern(const FitConditions& conditions, const FitReceiver& receiver,
                             const ModernFitSettings& settings, const DataFolders& data, const FitWatch& watch = {});

}  // namespace skyloop::inline campaigns
