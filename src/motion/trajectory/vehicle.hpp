/// What moves along a path, and what it can do.
/// Kinds of vehicles: how each stands in its motion, and what it can do at most.
/// How a vehicle gathers and loses speed along its way.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "base/core/units.hpp"

namespace skyloop::inline motion {

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

/// Limits along a way; m/s, m/s², m/s³.
struct SpeedLimits {
    double speed = 10, acceleration = 2, jerk = 2;
};

/// Where a vehicle is along its way; m, m/s, m/s².
struct AlongWay {
    double way = 0, speed = 0, acceleration = 0;
};

/// s until the speed has changed by that much, acceleration being zero before and after. @param change m/s
double speed_change_time(double change, const SpeedLimits& limits);
/// m that this takes
double speed_change_length(double from, double to, const SpeedLimits& limits);
/// The largest speed, at most `limits.speed`, to which one gets from `from` within a length.
double fastest_after(double from, double length, const SpeedLimits& limits);

/// Pieces of constant jerk, one after the other: seven of them are the S-curve (FEEDS.md 2.1; Biagiotti and Melchiorri,
/// Trajectory Planning for Automatic Machines and Robots, 3.4). The acceleration is continuous, and zero between the
/// calls of the functions that add.
class SpeedProfile {
public:
    /// @param speed at the beginning, m/s
    explicit SpeedProfile(double speed = 0) : speed_(speed) {}
    /// To another speed, as fast as the limits let.
    void change(double to, const SpeedLimits& limits);
    /// At the speed as it is; @param seconds also infinite
    void keep(double seconds);
    /// Over a length to a speed at its end, as fast as the limits let. @param to not beyond what change() reaches in
    /// that length, see fastest_after()
    void run(double length, double to, const SpeedLimits& limits);

    [[nodiscard]] AlongWay at(double t) const;
    [[nodiscard]] double duration() const { return ends_; }
    /// m from beginning to end
    [[nodiscard]] double length() const { return way_; }
    /// m/s at the end
    [[nodiscard]] double speed() const { return speed_; }

private:
    struct Segment {
        double begins, way, speed, acceleration, jerk;
    };
    void add(double seconds, double acceleration, double jerk);

    std::vector<Segment> segments_;
    double ends_ = 0, way_ = 0, speed_;
};

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

}  // namespace skyloop::inline motion
