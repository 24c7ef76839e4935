/// Velocities and covariances as seen from a place on the ground.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>

#include "base/geo/local_frame.hpp"
#include "world/flow/fix.hpp"

namespace skyloop {

/// 0 … 360°.
inline Angle course_of(const VelocityNed& v) {
    double course = std::atan2(v.east, v.north);
    if (course < 0) course += 2 * std::numbers::pi;
    return Angle::radians(course < 2 * std::numbers::pi ? course : 0);
}

/// A covariance of ECEF turned to east, north and up.
inline Eigen::Matrix3d in_enu(const LocalFrame& frame, const Eigen::Matrix3d& covariance) {
    Eigen::Matrix3d rotation;
    for (int axis = 0; axis < 3; ++axis)
        rotation.col(axis) = frame.to_enu(Displacement<Ecef>(Eigen::Vector3d::Unit(axis))).vector();
    return rotation * covariance * rotation.transpose();
}

}  // namespace skyloop
