/// How a vehicle stands, from how it moves.
#pragma once

#include <Eigen/Core>

#include "base/geo/attitude.hpp"
#include "motion/trajectory/vehicle.hpp"

namespace skyloop {

/// What its attitude follows from; east, north, up.
struct VehicleMotion {
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();      ///< m/s
    Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  ///< of the motion, gravity not in it; m/s²
    Angle heading;                                           ///< clockwise from north
};

/// Bank in turns, pitch with the way, by the class of the vehicle (FEEDS.md 1.13.4): a plane's turn is coordinated, a
/// multirotor leans with its thrust, cars and boats lean outward, a rocket stands on its tail.
Attitude attitude_of_vehicle(VehicleClass kind, const VehicleMotion& motion);

}  // namespace skyloop
