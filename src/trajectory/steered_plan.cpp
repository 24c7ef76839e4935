// Waypoints for planes, boats and cars.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "smooth_step.hpp"
#include "steered_shape.hpp"
#include "turn_speed.hpp"
#include "waypoint_parts.hpp"

namespace skyloop {
namespace {

constexpr double radian_degrees = 180 / std::numbers::pi;
constexpr double no_turn = 1e-9;  // rad

struct SteeredLeg {
    double length, heading;
    double speed;  // m/s
};

struct SteeredCorner {
    double angle = 0;   // rad
    double wanted = 0;  // of a leg, at full speed, m
    double speed = 0;   // in the turn
    TurnShape turn;
    double reach = 0;  // how far before the waypoint it begins, m
};

class SteeredPlanner {
public:
    explicit SteeredPlanner(const WaypointWish& wish) : wish_(wish) {}
    PathPlanResult plan();

private:
    using Mistake = std::optional<std::string>;
    Mistake measure_legs();
    Mistake measure_corners();
    Mistake fit_corner(std::size_t i);
    void lay_out();
    Mistake limit_climbs();
    [[nodiscard]] PathPlan timed();
    [[nodiscard]] std::size_t last() const { return wish_.waypoints.size() - 1; }
    // Of leg i: its straight part is section 2 i, the turn after it 2 i + 1.
    [[nodiscard]] double straight(std::size_t i) const {
        return std::max(0.0, legs_[i].length - corners_[i].reach - corners_[i + 1].reach);
    }

    const WaypointWish& wish_;
    std::vector<SteeredLeg> legs_;
    std::vector<SteeredCorner> corners_;
    std::shared_ptr<ClothoidCurve> curve_;
    std::vector<double> ways_;  // of the waypoints, along the curve
    PlanNotes notes_;
};

SteeredPlanner::Mistake SteeredPlanner::measure_legs() {
    constexpr double shortest_m = 1e-3;
    for (std::size_t i = 0; i < last(); ++i) {
        const PlannedWaypoint& waypoint = wish_.waypoints[i];
        const Eigen::Vector3d way = wish_.waypoints[i + 1].place - waypoint.place;
        const double length = way.head<2>().norm();
        if (length < shortest_m)
            return fmt::format(
                "from waypoint {} to {} it goes straight up or down, which a {} cannot; expected places "
                "that are apart on the ground",
                i + 1, i + 2, vehicle_name(wish_.vehicle.kind));
        if (wish_.vehicle.slowest > waypoint.speed)
            return fmt::format("waypoint {}: the speed is {:g} m/s; expected at least {:g}, the slowest of a {}", i + 1,
                               waypoint.speed, wish_.vehicle.slowest, vehicle_name(wish_.vehicle.kind));
        if (i > 0 && waypoint.hold > 0 && wish_.vehicle.slowest > 0)
            return fmt::format("waypoint {}: holds for {:g} s, and a {} cannot stop on its way; expected no hold_s",
                               i + 1, waypoint.hold, vehicle_name(wish_.vehicle.kind));
        legs_.push_back({length, std::atan2(way.x(), way.y()), waypoint.speed});
    }
    return std::nullopt;
}

SteeredPlanner::Mistake SteeredPlanner::measure_corners() {
    corners_.resize(wish_.waypoints.size());
    for (std::size_t i = 1; i < last(); ++i) {
        SteeredCorner& corner = corners_[i];
        corner.angle = std::remainder(legs_[i].heading - legs_[i - 1].heading, 2 * std::numbers::pi);
        corner.speed = std::min(legs_[i - 1].speed, legs_[i].speed);
        if (std::abs(corner.angle) < no_turn) continue;
        corner.wanted =
            std::min(wish_.vehicle.corner, tangent_length(turn_at_speed(wish_.vehicle, corner.angle, corner.speed)));
    }
    for (std::size_t i = 1; i < last(); ++i)
        if (std::abs(corners_[i].angle) >= no_turn)
            if (auto mistake = fit_corner(i)) return mistake;
    return std::nullopt;
}

SteeredPlanner::Mistake SteeredPlanner::fit_corner(std::size_t i) {
    SteeredCorner& corner = corners_[i];
    const double free =
        std::min({wish_.vehicle.corner, share_of_leg(legs_[i - 1].length, corner.wanted, corners_[i - 1].wanted),
                  share_of_leg(legs_[i].length, corner.wanted, corners_[i + 1].wanted)});
    const double asked = corner.speed;
    const auto speed = fastest_turn(wish_.vehicle, corner.angle, asked, free);
    if (!speed) {
        const double slowest = slowest_turn(wish_.vehicle);
        const TurnShape turn = turn_at_speed(wish_.vehicle, corner.angle, slowest);
        return fmt::format(
            "waypoint {}, a turn of {:.0f}°: a {}'s turn there has a radius of {:.1f} m at its slowest, "
            "{:.3g} m/s, and begins {:.1f} m before the waypoint, where {:.1f} m are free; expected "
            "waypoints further apart, a flatter corner or a smaller radius",
            i + 1, std::abs(corner.angle) * radian_degrees, vehicle_name(wish_.vehicle.kind), turn.radius, slowest,
            tangent_length(turn), free);
    }
    corner.speed = *speed;
    corner.turn = turn_at_speed(wish_.vehicle, corner.angle, corner.speed);
    corner.reach = tangent_length(corner.turn);
    if (corner.speed < asked * 0.5)
        notes_.add(fmt::format("waypoint {}, a turn of {:.0f}°: slowed to {:.3g} m/s", i + 1,
                               std::abs(corner.angle) * radian_degrees, corner.speed));
    return std::nullopt;
}

void SteeredPlanner::lay_out() {
    CurvePoint beginning;
    beginning.position = wish_.waypoints[0].place.head<2>();
    beginning.heading = legs_[0].heading;
    curve_ = std::make_shared<ClothoidCurve>(beginning);
    ways_.push_back(0);
    for (std::size_t i = 0; i < legs_.size(); ++i) {
        curve_->run(straight(i), 0);
        const double before = curve_->length();
        if (corners_[i + 1].reach > 0) add_turn(*curve_, corners_[i + 1].turn);
        ways_.push_back((before + curve_->length()) / 2);
    }
}

// A height that changes over a way by a smooth step is 1.875 times as steep in its middle as on average.
SteeredPlanner::Mistake SteeredPlanner::limit_climbs() {
    const VehicleLimits& v = wish_.vehicle;
    for (std::size_t i = 0; i < legs_.size(); ++i) {
        const double rise = wish_.waypoints[i + 1].place.z() - wish_.waypoints[i].place.z();
        const double length = ways_[i + 1] - ways_[i];
        if (rise == 0) continue;
        const double steepest = steepest_of_smooth_step * std::abs(rise) / length;
        const double vertical = rise > 0 ? v.climb : v.sink;
        const double allowed = std::min(vertical / steepest, std::sqrt(v.along.acceleration * length * length /
                                                                       (sharpest_of_smooth_step * std::abs(rise))));
        if (steepest > std::tan(v.steepest) || allowed < v.slowest)
            return fmt::format(
                "from waypoint {} to {} the height changes by {:.1f} m over {:.1f} m of way, up to {:.1f}° "
                "steep, {:.2g} m/s at its slowest; a {} is limited to {:g}° and {:g} m/s; expected a "
                "longer leg or a smaller change of height",
                i + 1, i + 2, rise, length, std::atan(steepest) * radian_degrees, steepest * std::max(v.slowest, 0.0),
                vehicle_name(v.kind), v.steepest * radian_degrees, vertical);
        if (allowed >= legs_[i].speed) continue;
        notes_.add(fmt::format("from waypoint {} to {} it goes at {:.3g} m/s instead of {:g}: limits of climb and sink",
                               i + 1, i + 2, allowed, legs_[i].speed));
        legs_[i].speed = allowed;
    }
    return std::nullopt;
}

PathPlan SteeredPlanner::timed() {
    std::vector<SpeedSection> sections;
    std::vector<double> speeds{0};
    for (std::size_t i = 0; i < legs_.size(); ++i) {
        const SteeredCorner& corner = corners_[i + 1];
        SpeedLimits limits = wish_.vehicle.along;
        limits.speed = legs_[i].speed;
        sections.push_back({straight(i), limits});
        const bool stops = i + 1 == last() || wish_.waypoints[i + 1].hold > 0;
        const double passes = i + 1 == last() ? 0 : std::min({corner.speed, legs_[i].speed, legs_[i + 1].speed});
        speeds.push_back(stops ? 0 : passes);
        limits.speed = passes;
        sections.push_back({corner.reach > 0 ? turn_length(corner.turn) : 0, limits});
        speeds.push_back(corner.reach > 0 ? passes : speeds.back());
    }
    make_speeds_reachable(sections, speeds);
    SpeedProfile profile;
    profile.keep(wish_.waypoints[0].hold);
    WayHeights heights(wish_.waypoints[0].place.z());
    for (std::size_t i = 0; i < legs_.size(); ++i) {
        profile.run(sections[2 * i].length, speeds[2 * i + 1], sections[2 * i].limits);
        if (speeds[2 * i + 1] == 0) profile.keep(std::max(wish_.waypoints[i + 1].hold, 1e-3));
        profile.run(sections[2 * i + 1].length, speeds[2 * i + 2], sections[2 * i + 1].limits);
        heights.add(ways_[i + 1], wish_.waypoints[i + 1].place.z());
    }
    return {std::make_shared<SteeredShape>(curve_, std::move(profile), std::move(heights)), notes_.take(), {}};
}

PathPlanResult SteeredPlanner::plan() {
    if (auto mistake = measure_legs()) return tl::unexpected(*mistake);
    if (auto mistake = measure_corners()) return tl::unexpected(*mistake);
    lay_out();
    if (auto mistake = limit_climbs()) return tl::unexpected(*mistake);
    return timed();
}

}  // namespace

PathPlanResult plan_steered(const WaypointWish& wish) { return SteeredPlanner(wish).plan(); }

}  // namespace skyloop
