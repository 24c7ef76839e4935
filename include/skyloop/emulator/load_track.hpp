/// The recorded path of a scenario, read and made ready.
#pragma once

#include <string>
#include <vector>

#include "skyloop/base/result.hpp"
#include "skyloop/geo/geoid.hpp"
#include "skyloop/scenario/scenario.hpp"

namespace skyloop {

/// What there is to say of a path that was loaded; all empty where the scenario has none.
struct LoadedTrack {
    std::string description;  ///< "track.csv, 600 rows in 599.000 s"
    std::vector<std::string> warnings;
};

/// Reads the file of a trajectory of kind "file" into its settings, and plans generated ones; does nothing for others.
/// @param geoid may be null: then heights above sea level are refused
/// @param start of the run
/// Fails with `outside` for a file that cannot be read, with `input` for what is wrong in it, with `usage` when its
/// rows are to keep a time that they do not have.
Result<LoadedTrack> load_track(Scenario& scenario, const Geoid* geoid, GpsTime start);

/// Plans a generated path with the seed of the run, unless it has its own. Fails with `input` where there is none.
Result<LoadedTrack> load_generated(GeneratedSettings& path, std::uint64_t run_seed);

/// When the first row of a loaded track happens in a run that begins at `start`.
GpsTime first_row_at(const FileSettings& file, GpsTime start);

}  // namespace skyloop
