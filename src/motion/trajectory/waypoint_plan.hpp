/// Ways through places that a vehicle can really go.
#pragma once

#include <limits>
#include <vector>

#include "motion/trajectory/local_shape.hpp"
#include "motion/trajectory/vehicle.hpp"

namespace skyloop::inline motion {

/// A place that a way leads to.
struct PlannedWaypoint {
    Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< east, north, height; m
    double speed = 0;                                 ///< from here to the next one, m/s
    double hold = 0;                                  ///< stop here for so long, s
    /// How far off what goes straight in space may pass, m; the vehicle's own corner may ask for less.
    double near = std::numeric_limits<double>::infinity();
    std::size_t item = 0;  ///< of a plan, as notes call it; 0: by its number among the waypoints
};

/// What is to be planned.
struct WaypointWish {
    std::vector<PlannedWaypoint> waypoints;
    VehicleLimits vehicle;
    double heading = 0;  ///< until it goes anywhere, rad
    /// Planes, boats and cars pass by places whose turn fits at no speed, and change height no steeper than they can.
    /// Both is told. For places that nobody chose for this vehicle.
    bool passes_by = false;
};

/// Rests at the first and at the last waypoint, and goes as fast as speeds and limits let between them.
///
/// Multirotors, rovers and pedestrians go straight in space; before a corner they leave the one leg and join the next
/// on a curve of the fifth degree, at the speed that the lateral acceleration and the jerk allow there; they stop at a
/// corner that is sharper than 150°, in space or from above, or where a leg is steeper than 80°, and turn where they
/// stand; on such legs they look where they did (FEEDS.md 2.2).
///
/// Planes, boats and cars go round corners on a clothoid, an arc and a clothoid, slower where the turn does not fit
/// otherwise; their height changes smoothly from waypoint to waypoint, over the way on the ground, along which their
/// speed counts. They stop where the turn begins.
///
/// No plan: fewer than two waypoints, a turn that fits at no speed, a leg that is too steep, a plane that is to stop.
PathPlanResult plan_waypoints(const WaypointWish& wish);

}  // namespace skyloop::inline motion
