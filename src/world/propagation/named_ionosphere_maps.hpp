/// Maps of the ionosphere, and whether a run can go by them.
#pragma once

#include <string>

#include "base/core/result.hpp"
#include "world/gnss/ephemeris.hpp"
#include "world/gnss/shell_ionosphere.hpp"

namespace skyloop::inline world {

/// Maps of the ionosphere and where they come from.
struct NamedIonosphereMaps {
    std::string file;  ///< for messages
    IonosphereMaps maps;
};

/// Fails with `input`, naming the file, where the maps do not span the run or one of them has no value somewhere on the
/// globe.
/// @param run its first and last instant
Result<void> check_coverage(const NamedIonosphereMaps& maps, const TimeSpan& run);

}  // namespace skyloop::inline world
