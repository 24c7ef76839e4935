/// Directions into a scene's sky.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "base/core/units.hpp"

namespace skyloop {

/// A unit vector in east, north and up. @param azimuth from north to east
inline Eigen::Vector3d direction_towards(Angle azimuth, Angle elevation) {
    const double horizontal = std::cos(elevation.rad());
    return {horizontal * std::sin(azimuth.rad()), horizontal * std::cos(azimuth.rad()), std::sin(elevation.rad())};
}

}  // namespace skyloop
