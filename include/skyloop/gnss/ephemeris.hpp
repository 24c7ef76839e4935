/// Broadcast orbit and clock of one satellite.
#pragma once

#include "skyloop/gnss/satellite.hpp"
#include "skyloop/time/gps_time.hpp"

namespace skyloop {

/// A Kepler-type ephemeris record (IS-GPS-200, 20.3.3.4.3; tables 20-I and 20-III). Angles in radians, times in GPST.
struct KeplerEphemeris {
    SatelliteId satellite;
    GpsTime toe;  ///< reference time of the orbit
    GpsTime toc;  ///< reference time of the clock

    double sqrt_a = 0;  ///< √m
    double e = 0;
    double i0 = 0;
    double idot = 0;       ///< rad/s
    double omega0 = 0;     ///< longitude of the ascending node at the start of the week of toe
    double omega = 0;      ///< argument of perigee
    double omega_dot = 0;  ///< rad/s
    double m0 = 0;
    double delta_n = 0;                                           ///< rad/s
    double cuc = 0, cus = 0, crc = 0, crs = 0, cic = 0, cis = 0;  ///< rad, rad, m, m, rad, rad

    double af0 = 0, af1 = 0, af2 = 0;  ///< s, s/s, s/s²
    double tgd = 0;                    ///< group delay of the first frequency, s

    int iode = 0;
    int iodc = 0;
    int health = 0;         ///< 0: healthy
    double accuracy_m = 0;  ///< user range accuracy, m
    double fit_interval_h = 0;
    [[nodiscard]] bool healthy() const { return health == 0; }
};

}  // namespace skyloop
