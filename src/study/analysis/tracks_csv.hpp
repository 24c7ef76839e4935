/// Satellite tracks as a table.
#pragma once

#include <span>
#include <string>

#include "world/sky/satellite_tracks.hpp"

namespace skyloop {

/// All points as CSV, ascending by time and then by satellite: time_utc,satellite,x_m,y_m,z_m (metres, to a
/// millimetre).
std::string tracks_csv(std::span<const SatelliteTrack> tracks);

}  // namespace skyloop
