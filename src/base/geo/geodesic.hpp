/// Shortest lines on the ellipsoid.
#pragma once

#include "base/geo/geodetic.hpp"

namespace skyloop {

/// A point on a geodesic and the direction in which the line runs there.
struct GeodesicPoint {
    Angle latitude;
    Angle longitude;
    Angle azimuth;            ///< of the line, clockwise from true north
    Metres reduced_length{};  ///< by how much the point moves sideways per radian that the line turns at its start
};

/// Where one arrives from `start` after `distance` in direction `azimuth` (Karney 2013, GeographicLib).
GeodesicPoint geodesic_direct(const Geodetic& start, Angle azimuth, Metres distance);

/// Length of the geodesic between two places, their heights left aside, and its azimuth at the first.
struct GeodesicLeg {
    Metres length;
    Angle azimuth;
};
GeodesicLeg geodesic_between(const Geodetic& from, const Geodetic& to);

}  // namespace skyloop
