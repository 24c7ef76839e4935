/// What moves along a path, and what it can do.
#pragma once

#include <array>
#include <string_view>

#include "motion/trajectory/speed_profile.hpp"
#include "motion/trajectory/vehicle_class.hpp"

namespace skyloop {

/// What a vehicle can do.
struct VehicleLimits {
    VehicleClass kind = VehicleClass::multirotor;
    SpeedLimits along{12, 4, 8};  ///< along its way
    double lateral = 4;           ///< acceleration in turns, m/s²
    double turn_ramp = 0;         ///< time until a turn has its full acceleration (roll in, rudder, steering), s
    double radius = 0;            ///< smallest, m
    double corner = 10;           ///< how far before a waypoint the turn there may begin, m
    double slowest = 0;           ///< speed, but at its start and end, m/s
    double climb = 5, sink = 3;   ///< m/s
    double steepest = 1.5;        ///< slope of its way, rad

    /// Round a corner on wheels, keel or wings; else it turns where it stands.
    [[nodiscard]] bool is_steered() const {
        return kind == VehicleClass::plane || kind == VehicleClass::boat || kind == VehicleClass::car;
    }
};

/// The defaults: speed, acceleration and jerk of FEEDS.md 2.1, the others ours, typical of small vehicles.
VehicleLimits usual_limits(VehicleClass kind);
/// "multirotor"
inline std::string_view vehicle_name(VehicleClass kind) { return traits_of(kind).name; }
/// The classes that waypoints can be driven by.
inline constexpr std::array driven_vehicles{VehicleClass::multirotor, VehicleClass::plane, VehicleClass::rover,
                                            VehicleClass::boat,       VehicleClass::car,   VehicleClass::pedestrian};

}  // namespace skyloop
