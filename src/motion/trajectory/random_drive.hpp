/// Drives through streets that nobody planned.
#pragma once

#include <cstdint>

#include "motion/trajectory/local_shape.hpp"
#include "motion/trajectory/vehicle.hpp"

namespace skyloop {

/// Streets are a grid; at each crossing the vehicle goes on, or turns left or right, and now and then it waits.
struct DriveWish {
    VehicleLimits vehicle;
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< of the area, where it begins; east, north, height; m
    double heading = 0;                                ///< of the streets, rad
    double area = 500;                                 ///< how far it goes from the centre, along the streets, m
    double block = 100;                                ///< between two crossings, m
    double seconds = 3600;                             ///< about how long it drives
    double stops = 0.2;                                ///< share of the crossings at which it waits, 5 to 40 s
    std::uint64_t seed = 1;
};
/// No plan: the area is smaller than a block, too many crossings, a turn that does not fit into a block.
PathPlanResult plan_drive(const DriveWish& wish);

}  // namespace skyloop
