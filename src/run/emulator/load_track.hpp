/// The recorded path of a scenario, read and made ready.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/core/result.hpp"
#include "base/geo/geoid.hpp"
#include "run/scenario/scenario.hpp"

namespace skyloop::inline run {

/// What there is to say of a path that was loaded; all empty where the scenario has none.
struct LoadedTrack {
    std::string description;  ///< "track.csv, 600 rows in 599.000 s"
    std::vector<std::string> warnings;
    std::vector<std::string> details{};  ///< what was found in the file, a line each
    std::optional<GpsTime> path_end{};   ///< when the last row is first reached; nothing: there is none
    std::optional<GpsTime> end{};        ///< of the run, by the path; nothing: the path does not end it
};

/// Reads the file of a trajectory of kind "file" into its settings, and plans generated ones; does nothing for others.
/// Where the gaps of a track are to be outages, adds these to the faults of the receivers that ride on it.
/// @param geoid may be null: then heights above sea level are refused
/// @param start of the run
/// Fails with `outside` for a file that cannot be read, with `input` for what is wrong in it, with `usage` when its
/// rows are to keep a time that they do not have, or that a delay, a skip or a scale would take from them.
Result<LoadedTrack> load_track(Scenario& scenario, const Geoid* geoid, GpsTime start);

/// Plans a generated path with the seed of the run, unless it has its own. Fails with `input` where there is none.
Result<LoadedTrack> load_generated(GeneratedSettings& path, std::uint64_t run_seed);

/// Whether a path of the scenario ends the run: end = "stop".
bool ends_with_its_path(const Scenario& scenario);

}  // namespace skyloop::inline run
