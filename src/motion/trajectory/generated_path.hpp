/// Generated paths as settings: what was asked for, and how it becomes a shape.
/// Ways that come back to where they began, and fields that are mown.
/// Vehicles that want to stay where they are, and do not quite: hovering in wind, floating on waves.
/// Drives through streets that nobody planned.
/// Rockets and balloons: flights that meet the limits of receivers (FEEDS.md 2.5).
/// Paths one after the other.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "base/geo/geodetic.hpp"
#include "motion/trajectory/local_shape.hpp"
#include "motion/trajectory/vehicle.hpp"
#include "motion/trajectory/waypoint_plan.hpp"

namespace skyloop::inline motion {

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

/// A multirotor that holds a place in gusts (FEEDS.md 2.4): on each axis six tones between 0.05 and 0.8 Hz, the
/// amplitudes falling with the power 5/6 of the frequency, as turbulence does; half as much upward.
struct HoverWish {
    Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< east, north, height; m
    double heading = 0;                               ///< rad
    double sway = 0.3;                                ///< root mean square on the horizontal axes, m
    double wind = 0;                                  ///< m/s, into which it leans
    double wind_from = 0;                             ///< rad, clockwise from north
    std::uint64_t seed = 1;
};
std::shared_ptr<const LocalShape> hover_shape(const HoverWish& wish);

/// A boat on waves, at anchor or under way, set by a current: five tones about the period of the waves, circles of the
/// water in their direction (Airy's waves on deep water), roll and pitch by the slope of the surface, and a slow yaw of
/// 2°. Its course is not its heading.
struct FloatWish {
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    double heading = 0;        ///< rad
    double speed = 0;          ///< through the water, m/s
    double wave_height = 0.5;  ///< significant: four times the root mean square of the surface, m
    double wave_period = 6;    ///< s
    double wave_from = 0;      ///< rad
    double current = 0;        ///< m/s
    double current_to = 0;     ///< rad
    std::uint64_t seed = 1;
};
std::shared_ptr<const LocalShape> float_shape(const FloatWish& wish);

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

/// Straight up on a motor, down on a drogue and then on the main parachute. Air of 1.225 kg/m³ · exp(−h / 8500 m),
/// constant gravity; heights from the pad on are heights above the ellipsoid, as if that were the sea.
struct RocketWish {
    Eigen::Vector3d pad = Eigen::Vector3d::Zero();  ///< east, north, height; m
    double heading = 0;                             ///< rad
    double boost = 100;                             ///< thrust by mass, m/s²
    double burn = 3;                                ///< s
    double drag = 1e-4;                             ///< of the air at sea level: ρ C_D A / 2 m, 1/m
    double drogue = 25;                             ///< falling speed at sea level, m/s
    double main = 6;
    double main_below = 300;  ///< above the pad, m
};
/// No plan: the thrust does not lift it, or the flight takes longer than four hours.
PathPlanResult plan_rocket(const RocketWish& wish);

/// Wind at a height; what lies between two layers has a cubic between theirs.
struct WindLayer {
    double height = 0;  ///< above the ellipsoid, m
    double speed = 0;   ///< m/s
    double to = 0;      ///< clockwise from north, rad
};
/// Ours: light at the ground, a jet of 25 m/s at 11 km, little above 20 km; eastward, as in the middle latitudes.
std::span<const WindLayer> usual_winds();

/// Up at a constant speed with the wind, burst, and down on a parachute whose speed falls with the air's density
/// (scale height 7500 m).
struct BalloonWish {
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    double heading = 0;
    double ascent = 5;             ///< m/s
    double burst = 30000;          ///< above the ellipsoid, m
    double descent = 6;            ///< at sea level, m/s
    std::vector<WindLayer> winds;  ///< ascending; empty: the usual ones
};
/// No plan: it bursts below the ground, or the wind takes it 1000 km away.
PathPlanResult plan_balloon(const BalloonWish& wish);

/// Settings with a name: "rocket_1km", "rocket_30km_M3"; false for another one, which changes nothing.
bool choose_rocket(RocketWish& wish, std::string_view preset);
/// "balloon_32km"
bool choose_balloon(BalloonWish& wish, std::string_view preset);

/// One of the paths of a sequence; all of them lie on one plane.
struct SequenceStep {
    std::shared_ptr<const LocalShape> shape;
    double seconds = LocalShape::endless;  ///< after which it is left, if it has not ended before
    VehicleLimits vehicle{};               ///< which goes it
};

/// From the end of each path a curve of the fifth degree leads to the beginning of the next, as long as its speed,
/// acceleration, jerk, climb, sink and slope need it and a turn of at most 90° a second; each is told. Where one curve
/// does not keep the limits, it stops on its way. Planes, boats and cars go round corners, as through waypoints, from
/// where they have come to rest. Position, velocity and acceleration are continuous (FEEDS.md 2.6), as are heading,
/// roll and pitch with both derivatives. Each step's vehicle stands as such; it becomes the next one on the curve
/// between.
/// @param vehicle whose limits joints keep, unless both steps are of another class: then those of the step that is left
/// @param loop after the last path comes the first one again
/// No plan: a path without an end that is not the last one; no curve within the limits.
PathPlanResult plan_sequence(const std::vector<SequenceStep>& steps, const VehicleLimits& vehicle, bool loop);

using PathWish = std::variant<WaypointWish, OrbitWish, RacetrackWish, FigureEightWish, LawnmowerWish, HoverWish,
                              FloatWish, DriveWish, RocketWish, BalloonWish>;
/// @param seed for those that roll dice and have none of their own
PathPlanResult plan_path(const PathWish& wish, std::uint64_t seed);

/// A path that is generated: one wish, or several one after the other.
struct GeneratedPath {
    struct Step {
        PathWish wish{};
        double seconds = LocalShape::endless;    ///< after which the next one takes over
        std::optional<VehicleLimits> vehicle{};  ///< which goes it; nothing: that of the path
    };
    Geodetic origin{};                    ///< of the plane on which the wishes lie
    std::vector<Step> steps{};            ///< at least one
    VehicleLimits vehicle{};              ///< the limits of what joins the steps; its attitude, where a step has no own
    bool loop = false;                    ///< begins anew when it has ended
    Seconds start_delay{0};               ///< stands at its beginning for so long
    std::optional<std::uint64_t> seed{};  ///< of its dice; nothing: the run's
};
PathPlanResult plan_generated(const GeneratedPath& path, std::uint64_t run_seed);

}  // namespace skyloop::inline motion
