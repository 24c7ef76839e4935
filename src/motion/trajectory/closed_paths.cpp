#include "motion/trajectory/generated_path.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "detail/smooth_step.hpp"
#include "detail/steered_parts.hpp"
#include "motion/trajectory/waypoint_plan.hpp"

namespace skyloop::inline motion {
namespace {

// The speed with which a curve can be run whose smallest radius is that.
struct CurveSpeed {
    double speed;
    std::vector<std::string> notes;
};
using CurveSpeedResult = tl::expected<CurveSpeed, std::string>;

CurveSpeedResult speed_on_curve(const VehicleLimits& vehicle, double radius) {
    const double asked = vehicle.along.speed, allowed = std::sqrt(vehicle.lateral * radius);
    if (radius < vehicle.radius)
        return tl::unexpected(
            fmt::format("its tightest turn has a radius of {:.1f} m; expected at least {:g}, the "
                        "smallest of a {}",
                        radius, vehicle.radius, vehicle_name(vehicle.kind)));
    if (std::min(asked, allowed) < vehicle.slowest)
        return tl::unexpected(
            fmt::format("its tightest turn, of {:.1f} m radius, allows {:.3g} m/s, and the speed is "
                        "{:g}; expected both at least {:g}, the slowest of a {}",
                        radius, allowed, asked, vehicle.slowest, vehicle_name(vehicle.kind)));
    if (asked <= allowed) return CurveSpeed{asked, {}};
    return CurveSpeed{allowed,
                      {fmt::format("goes at {:.3g} m/s instead of {:g}, as its tightest turn, of {:.1f} m "
                                   "radius, allows",
                                   allowed, asked, radius)}};
}

SpeedProfile lap_profile(const LapWish& lap, double speed, double length) {
    SpeedLimits limits = lap.vehicle.along;
    limits.speed = speed;
    SpeedProfile profile;
    if (lap.laps > 0) {
        profile.run(lap.laps * length, 0, limits);
    } else {
        profile.change(speed, limits);
        profile.keep(LocalShape::endless);
    }
    return profile;
}

PathPlan level_laps(const LapWish& lap, CurveSpeed speed, std::shared_ptr<const PlanarCurve> curve) {
    SpeedProfile profile = lap_profile(lap, speed.speed, curve->length());
    return {std::make_shared<SteeredShape>(std::move(curve), std::move(profile), WayHeights(lap.centre.z())),
            std::move(speed.notes),
            {}};
}

Eigen::Vector2d heading_direction(double heading) { return {std::sin(heading), std::cos(heading)}; }

}  // namespace

PathPlanResult plan_orbit(const OrbitWish& wish) {
    const LapWish& lap = wish.lap;
    auto speed = speed_on_curve(lap.vehicle, wish.radius);
    if (!speed) return tl::unexpected(speed.error());
    const auto curve = std::make_shared<CircleCurve>(
        CircleCurve::Shape{lap.centre.head<2>(), wish.radius, wish.start_azimuth, wish.anticlockwise});
    if (wish.climb == 0) return level_laps(lap, std::move(*speed), curve);
    if (lap.laps == 0)
        return tl::unexpected(std::string("it climbs for ever; expected a number of laps beside climb_m"));
    const double length = lap.laps * curve->length();
    const double steepest = steepest_of_smooth_step * std::abs(wish.climb) / length;
    const double vertical = wish.climb > 0 ? lap.vehicle.climb : lap.vehicle.sink;
    const double allowed = std::min(vertical / steepest, std::sqrt(lap.vehicle.along.acceleration * length * length /
                                                                   (sharpest_of_smooth_step * std::abs(wish.climb))));
    if (allowed < lap.vehicle.slowest || steepest > std::tan(lap.vehicle.steepest))
        return tl::unexpected(
            fmt::format("climbs {:g} m in {:.0f} m of way, too steep for a {} limited to {:g} m/s; "
                        "expected more laps or a smaller climb",
                        wish.climb, length, vehicle_name(lap.vehicle.kind), vertical));
    if (allowed < speed->speed) {
        speed->notes.push_back(
            fmt::format("goes at {:.3g} m/s instead of {:.3g}: limits of climb and sink", allowed, speed->speed));
        speed->speed = allowed;
    }
    WayHeights heights(lap.centre.z());
    heights.add(length, lap.centre.z() + wish.climb);
    return PathPlan{std::make_shared<SteeredShape>(curve, lap_profile(lap, speed->speed, curve->length()), heights),
                    speed->notes,
                    {}};
}

PathPlanResult plan_racetrack(const RacetrackWish& wish) {
    const LapWish& lap = wish.lap;
    TurnShape turn;
    turn.angle = std::numbers::pi;
    const double asked = lap.vehicle.along.speed;
    turn.radius = wish.radius > 0 ? wish.radius : std::max(asked * asked / lap.vehicle.lateral, lap.vehicle.radius);
    auto speed = speed_on_curve(lap.vehicle, turn.radius);
    if (!speed) return tl::unexpected(speed.error());
    constexpr double least_ramp = 0.5;  // s, for vehicles that turn at once
    turn.ramp = speed->speed * std::max(lap.vehicle.turn_ramp, least_ramp);
    ClothoidCurve one_turn({});
    add_turn(one_turn, turn);
    const double width = one_turn.end().position.x();
    const Eigen::Vector2d ahead = heading_direction(lap.heading), right(ahead.y(), -ahead.x());
    CurvePoint beginning;
    beginning.position = lap.centre.head<2>() - wish.straight / 2 * ahead - width / 2 * right;
    beginning.heading = lap.heading;
    const auto curve = std::make_shared<ClothoidCurve>(beginning);
    for (int half = 0; half < 2; ++half) {
        curve->run(wish.straight, 0);
        add_turn(*curve, turn);
    }
    curve->close();
    return level_laps(lap, std::move(*speed), curve);
}

PathPlanResult plan_figure_eight(const FigureEightWish& wish) {
    auto speed = speed_on_curve(wish.lap.vehicle, wish.half_length / 3);
    if (!speed) return tl::unexpected(speed.error());
    return level_laps(wish.lap, std::move(*speed),
                      std::make_shared<LemniscateCurve>(
                          LemniscateCurve::Shape{wish.lap.centre.head<2>(), wish.half_length, wish.lap.heading}));
}

PathPlanResult plan_lawnmower(const LawnmowerWish& wish) {
    const Eigen::Vector2d ahead = heading_direction(wish.heading), right(ahead.y(), -ahead.x());
    WaypointWish way;
    way.vehicle = wish.vehicle;
    way.heading = wish.heading;
    for (unsigned line = 0; line < wish.lines; ++line)
        for (unsigned end = 0; end < 2; ++end) {
            const double along = (line + end) % 2 == 0 ? 0 : wish.length;
            PlannedWaypoint waypoint;
            waypoint.place = wish.corner;
            waypoint.place.head<2>() += along * ahead + line * wish.spacing * right;
            waypoint.speed = wish.vehicle.along.speed;
            way.waypoints.push_back(waypoint);
        }
    return plan_waypoints(way);
}

}  // namespace skyloop::inline motion
