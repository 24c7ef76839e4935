/// What moves along a path, and what it can do.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "skyloop/trajectory/speed_profile.hpp"

namespace skyloop {

/// Classes of vehicles, by how they turn and stand (FEEDS.md 1.13.4).
enum class VehicleKind { multirotor, plane, rover, boat, car, pedestrian, balloon, rocket };

/// What a vehicle can do.
struct VehicleLimits {
    VehicleKind kind = VehicleKind::multirotor;
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
        return kind == VehicleKind::plane || kind == VehicleKind::boat || kind == VehicleKind::car;
    }
};

/// The defaults: speed, acceleration and jerk of FEEDS.md 2.1, the others ours, typical of small vehicles.
VehicleLimits usual_limits(VehicleKind kind);
/// "multirotor"
std::string_view vehicle_name(VehicleKind kind);
/// The kinds that waypoints can be driven by, in the order of the enumeration.
std::span<const std::string_view> steered_vehicle_names();

}  // namespace skyloop
