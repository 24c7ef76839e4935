/// The navigation data of a scenario's files, whatever is done with them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/core/result.hpp"
#include "run/emulator/data_folders.hpp"
#include "run/scenario/scenario.hpp"
#include "world/gnss/navigation_data.hpp"

namespace skyloop::inline run {

/// Reads the files of `sky.navigation`, of which there is at least one. load_navigation() adds what a run makes of
/// them. Fails with `input` for files that hold nothing to use.
/// @param near resolves the weeks of an almanac, where no file beside it tells the time of its records
/// @param warnings what is doubtful about the records is added here
Result<NavigationData> read_navigation_files(const Scenario& scenario, GpsTime near,
                                             std::vector<std::string>& warnings);

/// The navigation file that the cache has of the day of `time`. Fails with `outside` and what to do.
Result<std::filesystem::path> cached_navigation(const DataFolders& folders, GpsTime time);

}  // namespace skyloop::inline run
