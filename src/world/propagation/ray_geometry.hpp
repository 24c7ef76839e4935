/// A floor for models that divide by sin e.
/// Heights above sea level for models of the air, with or without a geoid.
/// Straight rays over a spherical Earth.
#pragma once

#include <algorithm>

#include "base/core/units.hpp"
#include "base/geo/geodetic.hpp"
#include "base/geo/geoid.hpp"

namespace skyloop::inline world {

/// The elevation, or 0.01° below it: a satellite on the very horizon has a large delay, not an infinite one.
inline Angle above_horizon(Angle elevation) { return std::max(elevation, Angle::degrees(0.01)); }

/// Height above the geoid; without a geoid the ellipsoid stands in for the sea (MODELS.md D-03).
inline MslHeight sea_level_height(const Geodetic& place, const Geoid* geoid) {
    const Metres undulation = geoid != nullptr ? geoid->undulation(place.latitude, place.longitude) : Metres(0);
    return above_sea_level(place.height, undulation);
}

/// A ray that leaves an antenna over a sphere.
struct SphericalRay {
    Angle elevation;
    Metres antenna_height;  ///< over the sphere
    Metres earth_radius{6371000};
};

/// Distance along the ray from the antenna to height `height` over the sphere; 0 at or below the antenna
/// (MODELS.md 3.6, S(h)).
Metres path_to_height(const SphericalRay& ray, Metres height);

/// Length of the ray between two heights; what lies below the antenna does not count (MODELS.md 3.6).
Metres shell_path(const SphericalRay& ray, Metres base, Metres top);

/// Elevation of the ray where it crosses `height`, seen from there.
Angle elevation_at_height(const SphericalRay& ray, Metres height);

/// The angle at a satellite between the centre of the Earth and the antenna (MODELS.md 7.7).
/// @param orbit_radius from the centre of the Earth
Angle off_boresight_angle(const SphericalRay& ray, Metres orbit_radius);

}  // namespace skyloop::inline world
