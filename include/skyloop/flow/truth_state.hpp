/// Where the antenna really is.
#pragma once

#include "skyloop/geo/frames.hpp"
#include "skyloop/geo/geodetic.hpp"
#include "skyloop/time/gps_time.hpp"

namespace skyloop {

/// The true state of the antenna at one instant. `geodetic` is `position` in other words, computed once.
struct TruthState {
    GpsTime time;
    Position<Ecef> position;
    Velocity<Ecef> velocity;
    Geodetic geodetic;
};

}  // namespace skyloop
