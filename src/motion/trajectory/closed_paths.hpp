/// Ways that come back to where they began, and fields that are mown.
#pragma once

#include "motion/trajectory/local_shape.hpp"
#include "motion/trajectory/vehicle.hpp"

namespace skyloop {

/// Of all of them: the speed is that of the vehicle's limits, less where a turn would ask for more lateral
/// acceleration than those have, which is told. They begin at rest, and go round for ever or come to rest after their
/// laps. Lengths in m, angles in rad, places as in GeodesicPlane.
struct LapWish {
    VehicleLimits vehicle;
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    double heading = 0;  ///< of the long axis, clockwise from north
    unsigned laps = 0;   ///< 0: for ever
};

/// Round a centre, up or down in the meantime: a helix.
struct OrbitWish {
    LapWish lap;
    double radius = 100;
    double start_azimuth = 0;  ///< from the centre
    bool anticlockwise = false;
    double climb = 0;  ///< from the beginning to the end of all laps
};
/// No plan: the radius is below the vehicle's, the speed below its slowest, a climb without a number of laps.
PathPlanResult plan_orbit(const OrbitWish& wish);

/// Two straights, and turns of 180° to the right whose curvature is continuous.
struct RacetrackWish {
    LapWish lap;
    double straight = 200;
    double radius = 0;  ///< of the turns; 0: the smallest that the speed allows
};
PathPlanResult plan_racetrack(const RacetrackWish& wish);

/// Bernoulli's lemniscate, whose curvature is zero in its crossing and 3 / half_length at its ends.
struct FigureEightWish {
    LapWish lap;
    double half_length = 60;
};
PathPlanResult plan_figure_eight(const FigureEightWish& wish);

/// Parallel lines from a corner of a field, each next one to the right of the one before.
struct LawnmowerWish {
    VehicleLimits vehicle;
    Eigen::Vector3d corner = Eigen::Vector3d::Zero();
    double heading = 0;  ///< of the first line
    double length = 200, spacing = 20;
    unsigned lines = 5;
};
PathPlanResult plan_lawnmower(const LawnmowerWish& wish);

}  // namespace skyloop
