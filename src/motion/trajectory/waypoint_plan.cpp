#include "motion/trajectory/waypoint_plan.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "detail/waypoint_parts.hpp"

namespace skyloop {
namespace {

// Places that lie on one another are one, which takes the stops and the last speed of all of them.
std::vector<PlannedWaypoint> without_repetitions(const std::vector<PlannedWaypoint>& waypoints) {
    constexpr double apart_m = 1e-3;
    std::vector<PlannedWaypoint> kept;
    for (const PlannedWaypoint& waypoint : waypoints) {
        if (kept.empty() || (waypoint.place - kept.back().place).norm() > apart_m) {
            kept.push_back(waypoint);
            continue;
        }
        kept.back().hold += waypoint.hold;
        kept.back().speed = waypoint.speed;
    }
    return kept;
}

}  // namespace

std::vector<std::string> PlanNotes::take() const {
    std::vector<std::string> all = notes_;
    if (count_ > notes_.size()) all.push_back(fmt::format("and {} more corners likewise", count_ - notes_.size()));
    return all;
}

std::string waypoint_called(const std::vector<PlannedWaypoint>& waypoints, std::size_t i) {
    const std::size_t item = waypoints.at(i).item;
    return item > 0 ? fmt::format("item {}", item) : fmt::format("waypoint {}", i + 1);
}

std::string leg_called(const std::vector<PlannedWaypoint>& waypoints, std::size_t i) {
    const std::size_t from = waypoints.at(i).item, to = waypoints.at(i + 1).item;
    if (from == 0 || to == 0) return fmt::format("from waypoint {} to {}", i + 1, i + 2);
    return from == to ? fmt::format("within item {}", from) : fmt::format("from item {} to {}", from, to);
}

void make_speeds_reachable(const std::vector<SpeedSection>& sections, std::vector<double>& stations) {
    for (std::size_t i = 0; i < sections.size(); ++i)
        stations[i + 1] = std::min(stations[i + 1], fastest_after(stations[i], sections[i].length, sections[i].limits));
    for (std::size_t i = sections.size(); i-- > 0;)
        stations[i] = std::min(stations[i], fastest_after(stations[i + 1], sections[i].length, sections[i].limits));
}

double room_for_turn(double wanted, const LegOfTurn& before, const LegOfTurn& after) {
    const auto share_of = [&](const LegOfTurn& leg) {
        const double sum = wanted + leg.wanted_by_other;
        return sum <= leg.length ? wanted : leg.length * wanted / sum;
    };
    return std::min(share_of(before), share_of(after));
}

double distance_from_leg(const Eigen::Vector3d& place, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    const Eigen::Vector3d leg = to - from;
    const double square = leg.squaredNorm();
    const double along = square > 0 ? std::clamp((place - from).dot(leg) / square, 0.0, 1.0) : 0;
    return (place - from - along * leg).norm();
}

PathPlanResult plan_waypoints(const WaypointWish& wish) {
    WaypointWish cleaned = wish;
    cleaned.waypoints = without_repetitions(wish.waypoints);
    if (cleaned.waypoints.size() < 2)
        return tl::unexpected(std::string("all waypoints lie at one place; expected two that are apart"));
    return wish.vehicle.is_steered() ? plan_steered(cleaned) : plan_fly_through(cleaned);
}

}  // namespace skyloop
