/// Which satellites stand above the antenna.
#pragma once

#include <vector>

#include "base/geo/frames.hpp"
#include "base/time/gps_time.hpp"
#include "world/flow/earlier_records.hpp"
#include "world/gnss/satellite.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop::inline world {

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
    Seconds clock_bias;          ///< satellite clock − GPST, relativity included
    double clock_drift = 0;      ///< s/s
    TransmittedSignals signals;  ///< the first one first; may be empty where only directions matter
    GpsTime toe;
    int iode = 0;
    bool healthy = true;
    EarlierRecords earlier_records;  ///< for models whose orbits are not quite those of the broadcast
    /// Of the first signal; 0 for a satellite without signals.
    [[nodiscard]] Seconds group_delay() const { return signals.empty() ? Seconds(0) : signals.front().group_delay; }
};

/// All satellites above the horizon at one instant, healthy or not, ascending by id.
struct SkyView {
    std::vector<SatelliteInView> satellites;
};

}  // namespace skyloop::inline world
