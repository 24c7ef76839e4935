/// Where a satellite is, how it moves, and what its clock shows.
#pragma once

#include "skyloop/geo/frames.hpp"
#include "skyloop/gnss/ephemeris.hpp"

namespace skyloop {

/// State of a satellite at one instant, in the ECEF frame of that same instant.
struct SatelliteState {
    Position<Ecef> position;
    Velocity<Ecef> velocity;
    double clock_bias = 0;         ///< satellite clock − GPST, s, relativity included, group delay not
    double clock_drift = 0;        ///< s/s, relativity included
    double relativistic_bias = 0;  ///< the eccentricity term alone, s
};

/// Orbit and clock by the user algorithm of IS-GPS-200 (20.3.3.4.3.1 and 20.3.3.3.3.1), velocity by its derivative
/// (Remondi 2004). @param offset added to `time`, s, for transmission times finer than a nanosecond
SatelliteState satellite_state(const KeplerEphemeris& ephemeris, GpsTime time, Seconds offset = Seconds(0));

}  // namespace skyloop
