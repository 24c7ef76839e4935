/// All mistakes of a scenario, not the first alone.
#pragma once

#include "base/core/result.hpp"
#include "run/emulator/assembly.hpp"

namespace skyloop {

/// `first`, and a line for each other mistake that shows when navigation data, track, timeline, live sources, scene and
/// receivers are each tried by themselves. A file that a key names and that is not there is a mistake at that key.
/// @param scenario as far as it could be read
/// @param now the wall clock, GPST
Error with_other_mistakes(const Error& first, const Scenario& scenario, const DataFolders& data, GpsTime now);

}  // namespace skyloop
