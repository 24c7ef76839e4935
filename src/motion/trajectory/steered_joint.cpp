#include "detail/steered_joint.hpp"

#include <array>
#include <numbers>

#include "detail/turn_speed.hpp"
#include "detail/waypoint_parts.hpp"

namespace skyloop {
namespace {

Eigen::Vector3d ahead_of(const LocalMotion& m) { return {std::sin(m.heading), std::cos(m.heading), 0}; }
Eigen::Vector3d right_of(const LocalMotion& m) { return {std::cos(m.heading), -std::sin(m.heading), 0}; }

// How far it goes straight at both ends, and to which side it turns out there: −1 left, 0 not, 1 right.
struct JointForm {
    double reach;
    double side_after_start, side_before_end;
};

std::vector<Eigen::Vector3d> places_of(const JointForm& form, const LocalMotion& from, const LocalMotion& to) {
    std::vector<Eigen::Vector3d> places{from.position, from.position + form.reach * ahead_of(from)};
    const auto aside = [&](const LocalMotion& end, double along, double side) -> Eigen::Vector3d {
        return end.position + 2 * form.reach * (along * ahead_of(end) + side * right_of(end));
    };
    if (form.side_after_start != 0) places.push_back(aside(from, 1, form.side_after_start));
    if (form.side_before_end != 0) places.push_back(aside(to, -1, form.side_before_end));
    places.push_back(to.position - form.reach * ahead_of(to));
    places.push_back(to.position);
    return places;
}

// The height changes evenly with the way over ground.
WaypointWish way_through(const std::vector<Eigen::Vector3d>& places, const VehicleLimits& vehicle) {
    const double rise = places.back().z() - places.front().z();
    double whole = 0;
    for (std::size_t i = 1; i < places.size(); ++i)
        whole += (places[i] - places[i - 1]).head<2>().norm();
    WaypointWish wish;
    wish.vehicle = vehicle;
    double way = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (i > 0) way += (places[i] - places[i - 1]).head<2>().norm();
        PlannedWaypoint waypoint;
        waypoint.place << places[i].head<2>(), places.front().z() + rise * way / whole;
        waypoint.speed = vehicle.along.speed;
        wish.waypoints.push_back(waypoint);
    }
    wish.waypoints.back().place = places.back();
    return wish;
}

}  // namespace

std::shared_ptr<const LocalShape> steered_joint(const LocalMotion& from, const LocalMotion& to,
                                                const VehicleLimits& vehicle) {
    constexpr std::array<double, 3> sides{0, -1, 1};
    constexpr std::array<double, 11> reaches{1, 1.5, 2, 3, 4, 6, 8, 12, 16, 24, 32};
    // What a turn of 90° takes of both its legs at half the speed.
    const double speed = std::max(vehicle.slowest, vehicle.along.speed / 2);
    const double unit = tangent_length(turn_at_speed(vehicle, std::numbers::pi / 2, speed));
    for (const double reach : reaches) {
        std::shared_ptr<const LocalShape> shortest;
        for (const double start : sides)
            for (const double end : sides) {
                const auto plan = plan_waypoints(way_through(places_of({reach * unit, start, end}, from, to), vehicle));
                if (plan && (!shortest || plan->shape->duration() < shortest->duration())) shortest = plan->shape;
            }
        if (shortest) return shortest;
    }
    return nullptr;
}

}  // namespace skyloop
