/// How a vehicle stands that tells only where it is.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "base/geo/geodetic.hpp"
#include "motion/trajectory/attitude_curve.hpp"
#include "motion/trajectory/vehicle_class.hpp"

namespace skyloop {

/// A vehicle's motion at one instant; north, east, down at its place.
struct MotionSample {
    double time = 0;  ///< s
    Geodetic place;
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();      ///< m/s
    Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  ///< m/s², gravity not in it
    bool jump = false;                                       ///< no way leads from the sample before to this one
};

/// The attitude by class, of attitude_of_vehicle(). Yaw by the course, held where the vehicle is slower than its
/// class's gate; a car, rover or boat that sets off backwards keeps its yaw (reverse gear). What goes on the ground
/// pitches by 20° at most. All angles pass a low-pass of 0.4 s without lag, and are within the limits of the
/// class.
/// @param samples in ascending time, evenly spaced between jumps
/// @param heading until it first moves; nothing: where it first goes
std::vector<AttitudeKnot> attitude_from_motion(std::span<const MotionSample> samples, VehicleClass vehicle,
                                               std::optional<Angle> heading);

}  // namespace skyloop
