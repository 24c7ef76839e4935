/// Latitude, longitude and height on the WGS-84 ellipsoid.
/// Shortest lines on the ellipsoid.
#pragma once

#include <tl/expected.hpp>

#include <span>
#include <string>
#include <vector>

#include "base/core/units.hpp"
#include "base/geo/frames.hpp"

namespace skyloop::inline base {

/// Height above the WGS-84 ellipsoid.
struct EllipsoidalHeight {
    Metres above_ellipsoid;
    auto operator<=>(const EllipsoidalHeight&) const = default;
};

/// Height above mean sea level (the geoid).
struct MslHeight {
    Metres above_sea_level;
    auto operator<=>(const MslHeight&) const = default;
};

/// Geodetic coordinates, WGS-84.
struct Geodetic {
    Angle latitude;   ///< −90 … +90°
    Angle longitude;  ///< −180 … +180°
    EllipsoidalHeight height;
    /// @param height_m metres above the ellipsoid
    static Geodetic degrees(double latitude, double longitude, double height_m);
};

/// The place that a user names, or what is wrong with it: "latitude is 91; expected …".
/// @param latitude degrees, −90 … 90
/// @param longitude degrees, −360 … 360; taken as −180 … 180
/// @param height_m metres above the ellipsoid, −10 000 … 10 000 000: below any ground, below the satellites
tl::expected<Geodetic, std::string> place_from_degrees(double latitude, double longitude, double height_m);

/// The corners of a polygon at height 0 from latitude, longitude, latitude …, or what is wrong with them.
tl::expected<std::vector<Geodetic>, std::string> corners_from_degrees(std::span<const double> numbers);

Position<Ecef> to_ecef(const Geodetic& place);
Geodetic to_geodetic(const Position<Ecef>& point);

/// Radii of curvature of the ellipsoid, metres: meridian M and prime vertical N (MODELS.md 3.10).
struct CurvatureRadii {
    double meridian = 0;
    double prime_vertical = 0;
};
CurvatureRadii curvature_radii(Angle latitude);

/// The height above mean sea level, given the geoid undulation N there: H = h − N.
inline MslHeight above_sea_level(EllipsoidalHeight height, Metres undulation) {
    return {height.above_ellipsoid - undulation};
}

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

}  // namespace skyloop::inline base
