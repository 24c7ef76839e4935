#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "detail/smooth_step.hpp"
#include "detail/steered_parts.hpp"
#include "detail/waypoint_parts.hpp"

namespace skyloop::inline motion {

WayHeights::Height WayHeights::at(double way) const {
    const auto after =
        std::upper_bound(knots_.begin(), knots_.end(), way, [](double value, const Knot& k) { return value < k.way; });
    if (after == knots_.begin()) return {knots_.front().height, 0, 0};
    if (after == knots_.end()) return {knots_.back().height, 0, 0};
    const Knot& from = *std::prev(after);
    const double length = after->way - from.way, rise = after->height - from.height;
    const SmoothStep step = smooth_step((way - from.way) / length);
    return {from.height + rise * step.value, rise * step.slope / length, rise * step.bend / (length * length)};
}

LocalMotion SteeredShape::at(double t) const {
    const AlongWay along = profile_.at(t);
    const CurvePoint point = curve_->at(along.way);
    const WayHeights::Height height = heights_.at(along.way);
    const double s = std::sin(point.heading), c = std::cos(point.heading);
    const double inward = along.speed * along.speed * point.curvature;
    LocalMotion m;
    m.position << point.position, height.value;
    m.velocity = along.speed * Eigen::Vector3d(s, c, height.slope);
    m.acceleration = {along.acceleration * s + inward * c, along.acceleration * c - inward * s,
                      along.acceleration * height.slope + along.speed * along.speed * height.bend};
    m.heading = point.heading;
    return m;
}

namespace {

bool on_same_ground(const PlannedWaypoint& a, const PlannedWaypoint& b) {
    return (a.place - b.place).head<2>().norm() < shortest_leg_m;
}

// The way begins at the height of its first place: what lies above that one is climbed to on the way on.
void merge(PlannedWaypoint& into, const PlannedWaypoint& waypoint, bool into_first) {
    if (!into_first) into.place.z() = waypoint.place.z();
    into.speed = waypoint.speed;
    into.hold += waypoint.hold;
}

// The places as a list of which any can go.
class TightTurns {
public:
    TightTurns(const std::vector<PlannedWaypoint>& waypoints, const VehicleLimits& vehicle);
    PassedPlaces pass_by();
    [[nodiscard]] std::vector<PlannedWaypoint> left() const;

private:
    struct Place {
        PlannedWaypoint waypoint;
        std::size_t before = 0, after = 0;  // the first is before itself, the last after itself
        bool gone = false;
        double length = 0, heading = 0;  // of the leg to the one after, m and rad
        double angle = 0, speed = 0;     // of the turn here, rad and m/s
        double wanted = 0;               // by the turn, of each leg, m
    };

    [[nodiscard]] bool is_corner(std::size_t i) const { return places_[i].before != i && places_[i].after != i; }
    void measure_leg(std::size_t from);
    void measure_turn(std::size_t i);
    [[nodiscard]] bool fits(std::size_t i) const;
    [[nodiscard]] std::vector<std::size_t> turns_that_do_not_fit() const;
    void take_out(std::size_t i);
    void close_up(std::size_t before);
    void look_again_around(std::size_t before);

    std::vector<Place> places_;
    std::size_t count_;
    const VehicleLimits& vehicle_;
    std::vector<std::size_t> to_look_at_;  // ascending
};

TightTurns::TightTurns(const std::vector<PlannedWaypoint>& waypoints, const VehicleLimits& vehicle)
    : count_(waypoints.size()), vehicle_(vehicle) {
    for (std::size_t i = 0; i < count_; ++i) {
        Place place{waypoints[i]};
        place.before = i == 0 ? 0 : i - 1;
        place.after = std::min(i + 1, count_ - 1);
        places_.push_back(place);
    }
    for (std::size_t i = 0; i + 1 < count_; ++i)
        measure_leg(i);
    for (std::size_t i = 1; i + 1 < count_; ++i) {
        measure_turn(i);
        to_look_at_.push_back(i);
    }
}

void TightTurns::measure_leg(std::size_t from) {
    Place& place = places_[from];
    const Eigen::Vector3d way = places_[place.after].waypoint.place - place.waypoint.place;
    place.length = way.head<2>().norm();
    place.heading = std::atan2(way.x(), way.y());
}

void TightTurns::measure_turn(std::size_t i) {
    Place& place = places_[i];
    const Place& before = places_[place.before];
    place.angle = std::remainder(place.heading - before.heading, 2 * std::numbers::pi);
    place.speed = std::min(before.waypoint.speed, place.waypoint.speed);
    place.wanted = wanted_by_turn(vehicle_, place.angle, place.speed);
}

bool TightTurns::fits(std::size_t i) const {
    const Place& place = places_[i];
    if (std::abs(place.angle) < no_turn) return true;
    const Place &before = places_[place.before], &after = places_[place.after];
    const double room = room_for_turn(place.wanted, {before.length, before.wanted}, {place.length, after.wanted});
    const double free = std::min(vehicle_.corner, room);
    const double slowest = std::min(slowest_turn(vehicle_), place.speed);
    return tangent_length(turn_at_speed(vehicle_, place.angle, slowest)) <= free;
}

std::vector<std::size_t> TightTurns::turns_that_do_not_fit() const {
    std::vector<std::size_t> found;
    for (const std::size_t i : to_look_at_) {
        const bool neighbour_goes = !found.empty() && found.back() == places_[i].before;
        if (!neighbour_goes && !fits(i)) found.push_back(i);
    }
    return found;
}

void TightTurns::take_out(std::size_t i) {
    Place& place = places_[i];
    place.gone = true;
    --count_;
    const bool is_last = place.after == i;
    places_[place.before].after = is_last ? place.before : place.after;
    if (!is_last) places_[place.after].before = place.before;
}

// After the place behind one is gone: the one that follows now may lie on the same ground.
void TightTurns::close_up(std::size_t before) {
    Place& place = places_[before];
    while (place.after != before && on_same_ground(place.waypoint, places_[place.after].waypoint)) {
        merge(place.waypoint, places_[place.after].waypoint, place.before == before);
        take_out(place.after);
    }
}

void TightTurns::look_again_around(std::size_t before) {
    const std::size_t after = places_[before].after;
    measure_leg(before);
    for (const std::size_t i : {before, after}) {
        places_[i].wanted = 0;
        if (is_corner(i)) measure_turn(i);
    }
    for (const std::size_t i : {places_[before].before, before, after, places_[after].after})
        if (is_corner(i)) to_look_at_.push_back(i);
}

PassedPlaces TightTurns::pass_by() {
    PassedPlaces passed;
    while (count_ > 2) {
        const std::vector<std::size_t> found = turns_that_do_not_fit();
        if (found.empty()) break;
        passed.count += found.size();
        for (const std::size_t i : found) {
            const auto place_of = [&](std::size_t k) -> const auto& { return places_[k].waypoint.place; };
            passed.farthest = std::max(passed.farthest, distance_from_leg(place_of(i), place_of(places_[i].before),
                                                                          place_of(places_[i].after)));
        }
        for (const std::size_t i : found)
            take_out(i);
        to_look_at_.clear();
        for (const std::size_t i : found)
            if (!places_[places_[i].before].gone) close_up(places_[i].before);
        for (const std::size_t i : found)
            if (!places_[places_[i].before].gone) look_again_around(places_[i].before);
        std::erase_if(to_look_at_, [&](std::size_t i) { return places_[i].gone; });
        std::sort(to_look_at_.begin(), to_look_at_.end());
        to_look_at_.erase(std::unique(to_look_at_.begin(), to_look_at_.end()), to_look_at_.end());
    }
    return passed;
}

std::vector<PlannedWaypoint> TightTurns::left() const {
    std::vector<PlannedWaypoint> left;
    for (const Place& place : places_)
        if (!place.gone) left.push_back(place.waypoint);
    return left;
}

}  // namespace

LeftOutAbove leave_out_same_ground(std::vector<PlannedWaypoint>& waypoints) {
    constexpr double told_m = 0.05;
    LeftOutAbove left_out;
    std::vector<PlannedWaypoint> kept;
    for (const PlannedWaypoint& waypoint : waypoints) {
        if (kept.empty() || !on_same_ground(waypoint, kept.back())) {
            kept.push_back(waypoint);
            continue;
        }
        const double rise = std::abs(waypoint.place.z() - kept.back().place.z());
        left_out.count += rise > told_m;
        left_out.most = std::max(left_out.most, rise);
        merge(kept.back(), waypoint, kept.size() == 1);
    }
    waypoints = std::move(kept);
    return left_out;
}

PassedPlaces pass_by_tight_turns(std::vector<PlannedWaypoint>& waypoints, const VehicleLimits& vehicle) {
    TightTurns turns(waypoints, vehicle);
    const PassedPlaces passed = turns.pass_by();
    waypoints = turns.left();
    return passed;
}

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

}  // namespace skyloop::inline motion
