/// Kinds of vehicles: how each stands in its motion, and what it can do at most.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "base/core/units.hpp"

namespace skyloop {

/// Balloons and rockets have paths of their own; no track is told to be theirs.
enum class VehicleClass : std::uint8_t { fixed, pedestrian, car, rover, boat, plane, multirotor, balloon, rocket };

/// What is known of a class. Limits are those of common vehicles, beyond which a path is told to be odd; none of them
/// bends a recorded path.
struct VehicleTraits {
    std::string_view name;
    double jerk_density = 0;  ///< √q of a white jerk, m/s³/√Hz (FEEDS.md 1.13.2, step 3)
    MetresPerSecond speed_limit, climb_limit;
    double acceleration_limit = 0;          ///< m/s²
    MetresPerSecond course_gate{};          ///< slower than this, the course tells nothing of the yaw (FEEDS.md 1.13.4)
    Angle turn_rate_limit{}, bank_limit{};  ///< the first in one second
};

inline constexpr std::size_t vehicle_class_count = 9;
/// Of these the first, those that a track or a route may be of.
inline constexpr std::size_t track_vehicle_count = 7;

/// In the order of VehicleClass.
const std::array<VehicleTraits, vehicle_class_count>& vehicle_classes();
/// What people call the first of them, those of tracks.
std::array<std::string_view, track_vehicle_count> track_vehicle_names();
const VehicleTraits& traits_of(VehicleClass vehicle);
/// The class of that name; nothing: there is none.
std::optional<VehicleClass> vehicle_class_named(std::string_view name);

}  // namespace skyloop
