/// Where Sun and Moon stand, as well as tides and the attitude of satellites need it.
#pragma once

#include <Eigen/Core>

#include "base/geo/frames.hpp"
#include "base/time/gps_time.hpp"

namespace skyloop::inline world {

/// The Sun by the low-precision formulas of the Astronomical Almanac (section C), good to 0.01° from 1950 to 2050; the
/// Moon by the series of O. Montenbruck and E. Gill (2000), Satellite Orbits, 3.3.2, with the equinox of date, good to
/// 0.1° and 500 km. Turned by the mean sidereal time (of 1982, IERS Technical Note 21, chapter 5) with UT1 taken as
/// UTC; nutation and polar motion are left out.
Position<Ecef> sun_position(GpsTime time);
Position<Ecef> moon_position(GpsTime time);

/// Greenwich mean sidereal time, rad, 0 … 2π.
double sidereal_time(GpsTime time);

/// The axes of a satellite that turns its panels to the Sun and its antenna to the Earth.
struct SatelliteAxes {
    Eigen::Vector3d x, y, z;
};
/// Nominal yaw steering, axes as the IGS names them whatever the maker calls them: z to the Earth, y along the panels'
/// axis, x on the Sun's side (O. Montenbruck et al. (2015), GNSS satellite geometry and attitude models, Advances in
/// Space Research 56(6), 2.2). Left out are turns at noon and midnight, which satellites make later than this, and
/// orbits that are flown with the panels across the track (BeiDou GEO, QZSS).
SatelliteAxes yaw_steering(const Position<Ecef>& satellite, const Position<Ecef>& sun);

}  // namespace skyloop::inline world
