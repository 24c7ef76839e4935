/// A scenario at rest, run where and when a receiver stood.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "base/geo/geodetic.hpp"
#include "base/time/gps_time.hpp"
#include "run/emulator/data_folders.hpp"
#include "run/fault/run_observer.hpp"
#include "run/scenario/scenario.hpp"

namespace skyloop::inline campaigns {

/// Where, when and under which sky.
struct FitConditions {
    Geodetic place;
    GpsTime start;
    Seconds length;
    std::vector<std::filesystem::path> navigation{};  ///< RINEX files of that day; empty: the nominal sky
    std::uint64_t seed = 1;
};

/// Who waits for a run.
struct FitWatch {
    const std::atomic<bool>* stop = nullptr;  ///< true: it is to end; null: nobody stops it
    std::function<void()> on_epoch{};         ///< called after each; may be empty
};

/// What was read for a run, and what its user should be told.
struct FitRunNotes {
    std::string navigation;  ///< what the orbits are
    std::vector<std::string> warnings;
};

/// The tables [run], [sky] and [trajectory] of such a scenario. Files are named by absolute paths.
/// @param remarks lines of comment at the top, each with its "# " and end
std::string conditions_text(const FitConditions& conditions, std::string_view remarks);

/// The scenario of a text; its name in messages is fit.toml.
Result<Scenario> read_fit_scenario(const std::string& text);

/// Runs a scenario of these conditions to its end, on the virtual clock and without wires. Fails as assemble() does,
/// and with `outside` where it was stopped.
Result<FitRunNotes> run_to_end(const Scenario& scenario, const FitConditions& conditions, const DataFolders& data,
                               RunObserver& observer, const FitWatch& watch);

/// Why a model has too few fixes to be compared: they are fewer than two.
Error too_few_fixes(const FitConditions& conditions, const std::string& navigation, std::size_t fixes);

}  // namespace skyloop::inline campaigns
