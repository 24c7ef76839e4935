/// Attitudes against the Earth as a whole, in which they can be compared from place to place.
#pragma once

#include <Eigen/Geometry>

#include "base/geo/attitude.hpp"
#include "base/geo/geodetic.hpp"

namespace skyloop {

/// The turn from north, east, down at a place to the axes of ECEF (MODELS.md 3.2).
Eigen::Quaterniond ned_to_ecef(const Geodetic& place);
/// The turn from the body's axes to those of ECEF.
inline Eigen::Quaterniond body_to_ecef(const Attitude& attitude, const Geodetic& place) {
    return ned_to_ecef(place) * attitude.body_to_ned();
}
/// The attitude at `place` of a body that is turned by `body_to_ecef`.
inline Attitude attitude_at(const Geodetic& place, const Eigen::Quaterniond& body_to_ecef) {
    return Attitude(ned_to_ecef(place).conjugate() * body_to_ecef);
}

}  // namespace skyloop
