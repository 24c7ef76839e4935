#include "detail/passed_places.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "detail/turn_speed.hpp"
#include "detail/waypoint_parts.hpp"

namespace skyloop {
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

}  // namespace skyloop
