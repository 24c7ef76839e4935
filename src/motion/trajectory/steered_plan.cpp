// Waypoints for planes, boats and cars.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>

#include "detail/smooth_step.hpp"
#include "detail/steered_parts.hpp"
#include "detail/waypoint_parts.hpp"

namespace skyloop::inline motion {
namespace {

constexpr double radian_degrees = 180 / std::numbers::pi;

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
    void wish_for_turns();
    Mistake fit_corners();
    Mistake fit_corner(std::size_t i);
    [[nodiscard]] double free_at(std::size_t i) const;
    Mistake pass_by();
    Mistake turn_round(const std::vector<PlannedWaypoint>& wanted);
    void lay_out();
    void level_climbs();
    void keep_ends(std::vector<double>& levels, const std::vector<double>& rises) const;
    [[nodiscard]] double highest_rise(double length) const;
    Mistake limit_climbs();
    [[nodiscard]] PathPlan timed();
    [[nodiscard]] std::size_t last() const { return wish_.waypoints.size() - 1; }
    // Of leg i: its straight part is section 2 i, the turn after it 2 i + 1.
    [[nodiscard]] double straight(std::size_t i) const {
        return std::max(0.0, legs_[i].length - corners_[i].reach - corners_[i + 1].reach);
    }

    WaypointWish wish_;
    std::vector<SteeredLeg> legs_;
    std::vector<SteeredCorner> corners_;
    std::shared_ptr<ClothoidCurve> curve_;
    std::vector<double> ways_;  // of the waypoints, along the curve
    PlanNotes notes_;
};

SteeredPlanner::Mistake SteeredPlanner::measure_legs() {
    legs_.clear();
    for (std::size_t i = 0; i < last(); ++i) {
        const PlannedWaypoint& waypoint = wish_.waypoints[i];
        const Eigen::Vector3d way = wish_.waypoints[i + 1].place - waypoint.place;
        const double length = way.head<2>().norm();
        if (length < shortest_leg_m)
            return fmt::format(
                "{} it goes straight up or down, which a {} cannot; expected places "
                "that are apart on the ground",
                leg_called(wish_.waypoints, i), vehicle_name(wish_.vehicle.kind));
        if (wish_.vehicle.slowest > waypoint.speed)
            return fmt::format("{}: the speed is {:g} m/s; expected at least {:g}, the slowest of a {}",
                               waypoint_called(wish_.waypoints, i), waypoint.speed, wish_.vehicle.slowest,
                               vehicle_name(wish_.vehicle.kind));
        if (i > 0 && waypoint.hold > 0 && wish_.vehicle.slowest > 0)
            return fmt::format("{}: holds for {:g} s, and a {} cannot stop on its way; expected no hold_s",
                               waypoint_called(wish_.waypoints, i), waypoint.hold, vehicle_name(wish_.vehicle.kind));
        legs_.push_back({length, std::atan2(way.x(), way.y()), waypoint.speed});
    }
    return std::nullopt;
}

void SteeredPlanner::wish_for_turns() {
    corners_.assign(wish_.waypoints.size(), {});
    for (std::size_t i = 1; i < last(); ++i) {
        SteeredCorner& corner = corners_[i];
        corner.angle = std::remainder(legs_[i].heading - legs_[i - 1].heading, 2 * std::numbers::pi);
        corner.speed = std::min(legs_[i - 1].speed, legs_[i].speed);
        corner.wanted = wanted_by_turn(wish_.vehicle, corner.angle, corner.speed);
    }
}

SteeredPlanner::Mistake SteeredPlanner::fit_corners() {
    for (std::size_t i = 1; i < last(); ++i)
        if (std::abs(corners_[i].angle) >= no_turn)
            if (auto mistake = fit_corner(i)) return mistake;
    return std::nullopt;
}

double SteeredPlanner::free_at(std::size_t i) const {
    return std::min(wish_.vehicle.corner,
                    room_for_turn(corners_[i].wanted, {legs_[i - 1].length, corners_[i - 1].wanted},
                                  {legs_[i].length, corners_[i + 1].wanted}));
}

// Leaves out places until every turn fits.
SteeredPlanner::Mistake SteeredPlanner::pass_by() {
    const LeftOutAbove left_out = leave_out_same_ground(wish_.waypoints);
    if (wish_.waypoints.size() < 2) return "all places lie above one another; expected two that are apart";
    if (left_out.count > 0)
        notes_.add(
            fmt::format("it does not go straight up or down ({} places, up to {:.1f} m): a {} climbs and sinks on "
                        "its way from place to place",
                        left_out.count, left_out.most, vehicle_name(wish_.vehicle.kind)));
    if (auto mistake = measure_legs()) return mistake;
    const std::vector<PlannedWaypoint> wanted = wish_.waypoints;
    const PassedPlaces passed = pass_by_tight_turns(wish_.waypoints, wish_.vehicle);
    if (wish_.waypoints.size() < 2) return turn_round(wanted);
    if (passed.count > 0)
        notes_.add(fmt::format(
            "{} places are passed by, up to {:.1f} m from the way between those beside them: a {} cannot turn there",
            passed.count, passed.farthest, vehicle_name(wish_.vehicle.kind)));
    return std::nullopt;
}

// How far to either side of a place, from which it came straight, the two corners lie by which it turns back across it,
// m: as far as their turns reach. Nothing where that is too wide for the way.
std::optional<double> aside_to_turn_back(const VehicleLimits& vehicle, double distance, double speed) {
    constexpr double margin = 1.01, square = std::numbers::pi / 2;
    double aside = 0;
    for (int i = 0; i < 8; ++i)
        aside = margin * tangent_length(turn_at_speed(vehicle, square + std::atan(aside / distance), speed));
    return aside <= std::min(distance / 2, vehicle.corner) ? std::optional(aside) : std::nullopt;
}

// A way that ends where it begins, and of which no turn was left: out to the farthest place, across it, and back.
SteeredPlanner::Mistake SteeredPlanner::turn_round(const std::vector<PlannedWaypoint>& wanted) {
    const auto way_to = [&](const PlannedWaypoint& w) -> Eigen::Vector2d {
        return (w.place - wanted.front().place).head<2>();
    };
    const auto farthest = std::max_element(wanted.begin(), wanted.end(), [&](const auto& a, const auto& b) {
        return way_to(a).norm() < way_to(b).norm();
    });
    const double distance = way_to(*farthest).norm(), asked = std::min(wanted.front().speed, farthest->speed),
                 slowest = std::min(asked, slowest_turn(wish_.vehicle));
    const std::string_view name = vehicle_name(wish_.vehicle.kind);
    auto aside = aside_to_turn_back(wish_.vehicle, distance, asked);
    if (!aside) aside = aside_to_turn_back(wish_.vehicle, distance, slowest);
    if (!aside)
        return fmt::format(
            "no turn fits, and at the farthest place, {:.1f} m from where it begins and ends, a {} does "
            "not turn back: its turn there has a radius of {:.1f} m at its slowest, {:.3g} m/s; expected "
            "waypoints further apart",
            distance, name, turn_at_speed(wish_.vehicle, std::numbers::pi / 2, slowest).radius, slowest);
    const Eigen::Vector2d out = way_to(*farthest) * (*aside / distance);
    PlannedWaypoint before = *farthest, after = *farthest;
    before.place.head<2>() += Eigen::Vector2d(-out.y(), out.x());
    after.place.head<2>() += Eigen::Vector2d(out.y(), -out.x());
    wish_.waypoints = {wanted.front(), before, after, wanted.back()};
    notes_.add(
        fmt::format("of {} places on its way the one farthest from where it begins and ends is gone to, {:.0f} m "
                    "away, and turned back at by corners {:.1f} m to either side: a {} cannot turn at the others",
                    wanted.size() - 2, distance, *aside, name));
    return std::nullopt;
}

SteeredPlanner::Mistake SteeredPlanner::fit_corner(std::size_t i) {
    SteeredCorner& corner = corners_[i];
    const double free = free_at(i);
    const double asked = corner.speed;
    const auto speed = fastest_turn(wish_.vehicle, corner.angle, asked, free);
    if (!speed) {
        const double slowest = slowest_turn(wish_.vehicle);
        const TurnShape turn = turn_at_speed(wish_.vehicle, corner.angle, slowest);
        return fmt::format(
            "{}, a turn of {:.0f}°: a {}'s turn there has a radius of {:.1f} m at its slowest, "
            "{:.3g} m/s, and begins {:.1f} m before the waypoint, where {:.1f} m are free; expected "
            "waypoints further apart, a flatter corner or a smaller radius",
            waypoint_called(wish_.waypoints, i), std::abs(corner.angle) * radian_degrees,
            vehicle_name(wish_.vehicle.kind), turn.radius, slowest, tangent_length(turn), free);
    }
    corner.speed = *speed;
    corner.turn = turn_at_speed(wish_.vehicle, corner.angle, corner.speed);
    corner.reach = tangent_length(corner.turn);
    if (corner.speed < asked * 0.5)
        notes_.add(fmt::format("{}, a turn of {:.0f}°: slowed to {:.3g} m/s", waypoint_called(wish_.waypoints, i),
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

// On a leg of that length; a little less than limit_climbs() refuses.
double SteeredPlanner::highest_rise(double length) const {
    constexpr double margin = 0.99;
    const VehicleLimits& v = wish_.vehicle;
    double slope = std::tan(v.steepest), bend = std::numeric_limits<double>::infinity();
    if (v.slowest > 0) {
        slope = std::min(slope, std::min(v.climb, v.sink) / v.slowest);
        bend = v.along.acceleration / (sharpest_of_smooth_step * v.slowest * v.slowest);
    }
    return margin * std::min(slope * length / steepest_of_smooth_step, bend * length * length);
}

// Moves heights that keep to the rises between them as little as lets the way begin where it should, on the ground of a
// take-off, and end where it should, if it can reach that from there.
void SteeredPlanner::keep_ends(std::vector<double>& levels, const std::vector<double>& rises) const {
    const double first = wish_.waypoints.front().place.z(), last_one = wish_.waypoints.back().place.z();
    double to_end = std::accumulate(rises.begin(), rises.end(), 0.0), from_start = 0;
    const bool reaches = std::abs(last_one - first) <= to_end;
    for (std::size_t i = 0; i < levels.size(); ++i) {
        if (reaches) levels[i] = std::clamp(levels[i], last_one - to_end, last_one + to_end);
        levels[i] = std::clamp(levels[i], first - from_start, first + from_start);
        if (i < rises.size()) from_start += rises[i], to_end = std::max(0.0, to_end - rises[i]);
    }
}

// Heights half way between the highest and the lowest that the vehicle can fly and that touch those asked for; both
// ends stay.
void SteeredPlanner::level_climbs() {
    const std::size_t count = wish_.waypoints.size();
    std::vector<double> rises, above, below;
    for (std::size_t i = 0; i + 1 < count; ++i)
        rises.push_back(highest_rise(ways_[i + 1] - ways_[i]));
    for (const PlannedWaypoint& waypoint : wish_.waypoints)
        above.push_back(waypoint.place.z());
    below = above;
    const auto reach = [&](std::size_t from, std::size_t to, double rise) {
        above[to] = std::max(above[to], above[from] - rise);
        below[to] = std::min(below[to], below[from] + rise);
    };
    for (std::size_t i = 0; i + 1 < count; ++i)
        reach(i, i + 1, rises[i]);
    for (std::size_t i = count - 1; i > 0; --i)
        reach(i, i - 1, rises[i - 1]);
    std::vector<double> levels;
    for (std::size_t i = 0; i < count; ++i)
        levels.push_back((above[i] + below[i]) / 2);
    keep_ends(levels, rises);
    constexpr double told_m = 0.05;
    double most = 0;
    for (std::size_t i = 0; i < count; ++i) {
        double& height = wish_.waypoints[i].place.z();
        const double level = levels[i];
        most = std::max(most, std::abs(level - height));
        height = level;
    }
    if (most > told_m)
        notes_.add(fmt::format("heights are changed by up to {:.1f} m: a {} goes no steeper", most,
                               vehicle_name(wish_.vehicle.kind)));
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
                "{} the height changes by {:.1f} m over {:.1f} m of way, up to {:.1f}° "
                "steep, {:.2g} m/s at its slowest; a {} is limited to {:g}° and {:g} m/s; expected a "
                "longer leg or a smaller change of height",
                leg_called(wish_.waypoints, i), rise, length, std::atan(steepest) * radian_degrees,
                steepest * std::max(v.slowest, 0.0), vehicle_name(v.kind), v.steepest * radian_degrees, vertical);
        if (allowed >= legs_[i].speed) continue;
        notes_.add(fmt::format("{} it goes at {:.3g} m/s instead of {:g}: limits of climb and sink",
                               leg_called(wish_.waypoints, i), allowed, legs_[i].speed));
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
    if (wish_.passes_by)
        if (auto mistake = pass_by()) return tl::unexpected(*mistake);
    if (auto mistake = measure_legs()) return tl::unexpected(*mistake);
    wish_for_turns();
    if (auto mistake = fit_corners()) return tl::unexpected(*mistake);
    lay_out();
    if (wish_.passes_by) level_climbs();
    if (auto mistake = limit_climbs()) return tl::unexpected(*mistake);
    return timed();
}

}  // namespace

PathPlanResult plan_steered(const WaypointWish& wish) { return SteeredPlanner(wish).plan(); }

}  // namespace skyloop::inline motion
