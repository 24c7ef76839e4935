/// Which satellites stand above the antenna.
#pragma once

#include <vector>

#include "skyloop/geo/frames.hpp"
#include "skyloop/gnss/satellite.hpp"
#include "skyloop/time/gps_time.hpp"

namespace skyloop {

/// One satellite above the horizon, seen with light time and Earth rotation.
struct SatelliteInView {
    SatelliteId id;
    Angle azimuth;  ///< 0 … 360°
    Angle elevation;
    Metres range;                ///< geometric, in the frame of the reception instant
    MetresPerSecond range_rate;  ///< derivative of the light-time range, receiver motion included
    Seconds travel_time;
    Position<Ecef> position_at_transmission;  ///< in the ECEF frame of the transmission instant
    Velocity<Ecef> velocity_at_transmission;
    Seconds clock_bias;      ///< satellite clock − GPST, relativity included
    double clock_drift = 0;  ///< s/s
    Seconds group_delay;     ///< of the system's first signal (gnss/signal.hpp)
    GpsTime toe;
    int iode = 0;
    bool healthy = true;
};

/// All satellites above the horizon at one instant, healthy or not, ascending by id.
struct SkyView {
    std::vector<SatelliteInView> satellites;
};

}  // namespace skyloop
