// Which places of a route matter, and which times of a track do.
#include "motion/trajectory/route.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "detail/waypoint_parts.hpp"
#include "motion/trajectory/waypoint_plan.hpp"

namespace skyloop::inline motion {
namespace {

constexpr std::size_t places_of_a_block = 1024;

// Of one block, both ends of which are kept.
void keep_what_matters(std::span<const Eigen::Vector3d> places, std::size_t first, double tolerance,
                       std::vector<bool>& kept) {
    struct Stretch {
        std::size_t from, to;
    };
    std::vector<Stretch> open{{first, std::min(first + places_of_a_block, places.size() - 1)}};
    while (!open.empty()) {
        const Stretch stretch = open.back();
        open.pop_back();
        double farthest = tolerance;
        std::size_t at = stretch.from;
        for (std::size_t i = stretch.from + 1; i < stretch.to; ++i) {
            const double distance = distance_from_leg(places[i], places[stretch.from], places[stretch.to]);
            if (distance > farthest) farthest = distance, at = i;
        }
        if (at == stretch.from) continue;
        kept[at] = true;
        open.push_back({stretch.from, at});
        open.push_back({at, stretch.to});
    }
}

}  // namespace

std::vector<std::size_t> places_that_matter(std::span<const Eigen::Vector3d> places, double tolerance) {
    std::vector<std::size_t> indices;
    if (places.empty()) return indices;
    std::vector<bool> kept(places.size(), false);
    kept.back() = true;
    for (std::size_t first = 0; first + 1 < places.size(); first += places_of_a_block) {
        kept[first] = true;
        keep_what_matters(places, first, tolerance, kept);
    }
    for (std::size_t i = 0; i < kept.size(); ++i)
        if (kept[i]) indices.push_back(i);
    return indices;
}

void find_useless_times(Track& track) {
    if (track.route || track.points.empty()) return;
    std::map<Nanoseconds, std::size_t> counts;
    for (const TrackRow& row : track.points)
        ++counts[row.time];
    std::size_t most = 0;
    for (const auto& [time, count] : counts)
        most = std::max(most, count);
    const std::size_t rows = track.points.size();
    const bool apart = std::any_of(track.points.begin(), track.points.end(), [&](const TrackRow& row) {
        return (row.position - track.points.front().position).length().value() > 0;
    });
    if (counts.size() > 1 && !(apart && rows - most < rows / 10)) return;
    track.route.emplace();
    track.origin.reset();
    track.route->why = rows == 1 ? "one place alone"
                                 : fmt::format("{} of {} times are equal: the file's times are not used", most, rows);
}

namespace {

constexpr double whole_turn = 2 * std::numbers::pi;
constexpr std::size_t most_corners = 100'000;  // of a plan with circles

class StandingShape : public LocalShape {
public:
    StandingShape(const Eigen::Vector3d& place, double heading) {
        stands_.position = place;
        stands_.heading = heading;
    }
    [[nodiscard]] LocalMotion at(double) const override { return stands_; }
    [[nodiscard]] double duration() const override { return endless; }

private:
    LocalMotion stands_;
};

class RoutePlanner {
public:
    RoutePlanner(const Track& track, const RouteSettings& settings)
        : track_(track), settings_(settings), route_{GeodesicPlane(to_geodetic(track.points.front().position)), {}} {}
    Result<FlownRoute> plan();

private:
    [[nodiscard]] tl::unexpected<Error> refusal(const std::string& what, std::size_t line = 0) const;
    Result<void> lay_on_plane();
    Result<void> choose_vehicle();
    void stand();
    void keep_what_matters();
    void follow_plan();
    void add_stop(const RouteStop& stop, const Eigen::Vector3d& place, double speed);
    void add_circles(const RouteStop& stop, const Eigen::Vector3d& centre, double speed);

    const Track& track_;
    const RouteSettings& settings_;
    FlownRoute route_;
    VehicleLimits limits_;
    double speed_ = 0;
    std::vector<Eigen::Vector3d> places_;
    std::size_t not_held_ = 0;
    bool too_long_ = false;
};

tl::unexpected<Error> RoutePlanner::refusal(const std::string& what, std::size_t line) const {
    return fail(ErrorCode::input, line > 0 ? fmt::format("{}:{}: {}", track_.name, line, what)
                                           : fmt::format("{}: {}", track_.name, what));
}

Result<void> RoutePlanner::lay_on_plane() {
    constexpr double farthest_m = 1e6;
    for (const TrackRow& row : track_.points) {
        places_.push_back(route_.plane.to_local(to_geodetic(row.position)));
        const double distance = places_.back().head<2>().norm();
        if (!(distance <= farthest_m))
            return refusal(
                fmt::format("a place lies {:.0f} km from the first one of the route; expected at most {:.0f}",
                            distance / 1000, farthest_m / 1000),
                row.line);
    }
    return {};
}

Result<void> RoutePlanner::choose_vehicle() {
    route_.vehicle = settings_.vehicle.value_or(track_.route->vehicle.value_or(VehicleClass::multirotor));
    if (route_.vehicle == VehicleClass::fixed)
        return refusal(fmt::format("a route of {} places, which vehicle = \"fixed\" does not go; expected another one",
                                   places_.size()));
    limits_ = usual_limits(route_.vehicle);
    const auto asked = settings_.speed ? settings_.speed : track_.route->speed;
    speed_ = limits_.along.speed = asked.value_or(limits_.along.speed);
    if (speed_ >= limits_.slowest) return {};
    return refusal(fmt::format("a route at {:g} m/s, and the slowest of a {} is {:g}; expected a higher speed_mps",
                               speed_, vehicle_name(limits_.kind), limits_.slowest));
}

void RoutePlanner::stand() {
    route_.shape = std::make_shared<StandingShape>(places_.front(), settings_.heading);
    route_.vehicle = settings_.vehicle.value_or(VehicleClass::fixed);
    route_.notes.push_back(
        places_.size() == 1
            ? "one place alone: it is stood at, as by a fixed antenna"
            : fmt::format("all {} places are one: it is stood at, as by a fixed antenna", places_.size()));
}

void RoutePlanner::keep_what_matters() {
    for (const std::size_t i : places_that_matter(places_, settings_.tolerance))
        route_.waypoints.push_back({places_[i], speed_, 0, settings_.tolerance});
    const std::size_t left_out = places_.size() - route_.waypoints.size();
    if (left_out > 0)
        route_.notes.push_back(
            fmt::format("{} places lie within {:g} m of the way between the other {}, and are not "
                        "flown to (route_tolerance_m)",
                        left_out, settings_.tolerance, route_.waypoints.size()));
}

// Corners of a polygon round the circle, so that curves that cut them touch it; it begins where a straight way from the
// place before touches the circle.
void RoutePlanner::add_circles(const RouteStop& stop, const Eigen::Vector3d& centre, double speed) {
    constexpr double corners_of_turn = 16, most_turns = 1000;
    const double sign = stop.radius < 0 ? -1 : 1, radius = std::abs(stop.radius);
    const double to_corner = radius / std::cos(std::numbers::pi / corners_of_turn);
    double turns = stop.turns;
    if (turns == 0) turns = std::ceil(stop.hold * speed / (whole_turn * radius));
    turns = std::clamp(turns, 0.0, most_turns);
    double bearing = 0;
    if (!route_.waypoints.empty()) {
        const Eigen::Vector2d back = (route_.waypoints.back().place - centre).head<2>();
        bearing = std::atan2(back.x(), back.y());
        if (back.norm() > to_corner) bearing += sign * std::acos(to_corner / back.norm());
    }
    const auto corners = static_cast<std::size_t>(std::ceil(corners_of_turn * turns));
    too_long_ = too_long_ || route_.waypoints.size() + corners > most_corners;
    if (too_long_) return;
    for (std::size_t i = 0; i <= corners; ++i) {
        const double at = bearing + sign * whole_turn * static_cast<double>(i) / corners_of_turn;
        const Eigen::Vector3d corner(std::sin(at), std::cos(at), 0);
        route_.waypoints.push_back({centre + to_corner * corner, speed, 0});
        route_.waypoints.back().item = stop.item;
    }
    ++route_.circles;
    route_.corners += corners + 1;
}

void RoutePlanner::add_stop(const RouteStop& stop, const Eigen::Vector3d& place, double speed) {
    const bool stands = limits_.slowest == 0;
    if (stop.radius != 0 && (stop.turns > 0 || (stop.hold > 0 && !stands))) return add_circles(stop, place, speed);
    not_held_ += stop.hold > 0 && !stands;
    route_.waypoints.push_back({place, speed, stands ? stop.hold : 0});
    route_.waypoints.back().item = stop.item;
}

void RoutePlanner::follow_plan() {
    double speed = speed_;
    std::size_t too_slow = 0;
    for (std::size_t i = 0; i < places_.size(); ++i) {
        const RouteStop& stop = track_.route->stops[i];
        if (stop.speed && *stop.speed < limits_.slowest) ++too_slow;
        if (stop.speed) speed = std::max({*stop.speed, limits_.slowest, 0.01});
        add_stop(stop, places_[i], speed);
    }
    const std::string_view name = vehicle_name(limits_.kind);
    if (too_slow > 0)
        route_.notes.push_back(fmt::format("{} speeds are below {:g} m/s, the slowest of a {}, which they become",
                                           too_slow, limits_.slowest, name));
    if (not_held_ > 0) route_.notes.push_back(fmt::format("{} stops are not made: a {} cannot stand", not_held_, name));
}

Result<FlownRoute> RoutePlanner::plan() {
    if (const auto laid = lay_on_plane(); !laid) return fail(laid.error());
    route_.places = places_.size();
    const bool at_one_place = std::all_of(places_.begin(), places_.end(), [&](const Eigen::Vector3d& place) {
        constexpr double apart_m = 1e-3;
        return (place - places_.front()).norm() <= apart_m;
    });
    if (at_one_place && track_.route->stops.empty()) return stand(), std::move(route_);
    if (const auto chosen = choose_vehicle(); !chosen) return fail(chosen.error());
    const std::string what = track_.route->stops.empty() ? "a route" : "a plan";
    route_.notes.push_back(fmt::format("{}: flown as {} of {} points at {:.4g} m/s, as a {}", track_.route->why, what,
                                       places_.size(), speed_, vehicle_name(limits_.kind)));
    track_.route->stops.empty() ? keep_what_matters() : follow_plan();
    if (too_long_)
        return refusal(fmt::format("a plan with circles of more than {} corners, 16 to a turn; expected fewer turns",
                                   most_corners));
    WaypointWish wish{route_.waypoints, limits_, settings_.heading, true};
    auto plan = plan_waypoints(wish);
    if (!plan) return refusal(plan.error());
    route_.shape = std::move(plan->shape);
    route_.notes.insert(route_.notes.end(), plan->notes.begin(), plan->notes.end());
    return std::move(route_);
}

}  // namespace

Result<FlownRoute> fly_route(const Track& track, const RouteSettings& settings) {
    if (track.points.empty())
        return fail(ErrorCode::input, fmt::format("{}: a route without a place; expected one or more", track.name));
    return RoutePlanner(track, settings).plan();
}

RoutePath::RoutePath(const FlownRoute& route, GpsTime start)
    : start_(start), path_(start, route.plane, route.shape, route.vehicle) {}

Eigen::Vector3d RoutePath::acceleration(GpsTime time) const {
    constexpr double step_s = 1e-3;
    const auto velocity = [&](double after) { return path_.at(advanced(time, Seconds(after))).velocity.vector(); };
    return (velocity(step_s) - velocity(-step_s)) / (2 * step_s);
}

}  // namespace skyloop::inline motion
