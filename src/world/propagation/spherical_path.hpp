/// Straight rays over a spherical Earth.
#pragma once

#include "base/core/units.hpp"

namespace skyloop {

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

}  // namespace skyloop
