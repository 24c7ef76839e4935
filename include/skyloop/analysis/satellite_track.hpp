/// Where a satellite was over some hours, in the Earth-fixed frame.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "skyloop/geo/frames.hpp"
#include "skyloop/gnss/satellite.hpp"
#include "skyloop/time/gps_time.hpp"

namespace skyloop {

struct TrackPoint {
    GpsTime time;
    Position<Ecef> position;
};

/// The points of one satellite, ascending in time. A gap in the navigation data is a gap in time between two points.
struct SatelliteTrack {
    SatelliteId satellite;
    std::vector<TrackPoint> points;
};

/// All points as CSV, ascending by time and then by satellite: time_utc,satellite,x_m,y_m,z_m (metres, to a
/// millimetre).
std::string tracks_csv(std::span<const SatelliteTrack> tracks);

}  // namespace skyloop
