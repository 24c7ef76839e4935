// Waypoints for what can stop and turn anywhere: straight legs, and corners that are cut.
#include "motion/trajectory/waypoint_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "detail/knot_curve.hpp"
#include "detail/smooth_step.hpp"
#include "detail/waypoint_parts.hpp"

namespace skyloop::inline motion {
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

namespace {

constexpr double sharpest_cut = 150 * std::numbers::pi / 180;
constexpr double least_horizontal = 0.17;  // of a leg's direction: 80° of slope

// A part of the way in time: standing and turning, straight ahead, or round a corner.
struct TimedPart {
    enum class Kind { turn, straight, corner } kind = Kind::turn;
    double begins = 0, seconds = 0;
    Eigen::Vector3d from = Eigen::Vector3d::Zero(), direction = Eigen::Vector3d::Zero();
    SpeedProfile profile;
    QuinticPiece corner;
    double heading = 0, turned = 0, turning_s = 0;  // by how much, how long
    bool follows_course = true;                     // round a corner; else it looks where it did
};

class FlyThroughShape : public LocalShape {
public:
    void add(TimedPart part) {
        part.begins = duration_;
        duration_ += part.seconds;
        parts_.push_back(std::move(part));
    }
    [[nodiscard]] LocalMotion at(double t) const override;
    [[nodiscard]] double duration() const override { return duration_; }

private:
    std::vector<TimedPart> parts_;
    double duration_ = 0;
};

LocalMotion FlyThroughShape::at(double t) const {
    t = std::clamp(t, 0.0, duration_);
    const auto after = std::upper_bound(parts_.begin() + 1, parts_.end(), t,
                                        [](double value, const TimedPart& part) { return value < part.begins; });
    const TimedPart& part = *std::prev(after);
    const double inside = std::min(t - part.begins, part.seconds);
    LocalMotion m;
    if (part.kind == TimedPart::Kind::corner) {
        m = part.corner.at(inside);
        m.heading = part.follows_course ? std::atan2(m.velocity.x(), m.velocity.y()) : part.heading;
        return m;
    }
    m.position = part.from;
    m.heading = part.heading;
    if (part.kind == TimedPart::Kind::straight) {
        const AlongWay along = part.profile.at(inside);
        m.position += along.way * part.direction;
        m.velocity = along.speed * part.direction;
        m.acceleration = along.acceleration * part.direction;
    } else if (part.turning_s > 0) {
        m.heading += part.turned * smooth_step(inside / part.turning_s).value;
    }
    return m;
}

struct FlownLeg {
    Eigen::Vector3d direction;
    double length, heading;
    SpeedLimits limits;
    bool has_course;  // it is not upright
};

struct FlownCorner {
    double half_sine = 0;   // sin(θ/2)
    double cut = 0;         // how far before the waypoint it begins, m
    double speed = 0;       // m/s; 0: stops
    double wanted_cut = 0;  // at full speed
    double angle = 0;       // θ
};

class FlyThroughPlanner {
public:
    explicit FlyThroughPlanner(const WaypointWish& wish) : wish_(wish) {}
    PathPlanResult plan();

private:
    void measure_legs();
    void measure_corners();
    void share_legs();
    std::shared_ptr<const LocalShape> lay_out(const std::vector<double>& speeds) const;
    void stand(FlyThroughShape& shape, std::size_t at, double hold) const;
    [[nodiscard]] double straight(std::size_t leg) const {
        return std::max(0.0, legs_[leg].length - corners_[leg].cut - corners_[leg + 1].cut);
    }

    const WaypointWish& wish_;
    std::vector<FlownLeg> legs_;
    std::vector<FlownCorner> corners_;  // one for each waypoint; the first and the last have no cut
    PlanNotes notes_;
};

void FlyThroughPlanner::measure_legs() {
    const VehicleLimits& v = wish_.vehicle;
    double heading = wish_.heading;
    for (std::size_t i = 0; i + 1 < wish_.waypoints.size(); ++i) {
        const Eigen::Vector3d way = wish_.waypoints[i + 1].place - wish_.waypoints[i].place;
        FlownLeg leg{way.normalized(), way.norm(), heading, v.along, false};
        leg.has_course = leg.direction.head<2>().norm() > least_horizontal;
        if (leg.has_course) leg.heading = heading = std::atan2(way.x(), way.y());
        leg.limits.speed = wish_.waypoints[i].speed;
        const double vertical = leg.direction.z() > 0 ? v.climb : v.sink;
        if (leg.limits.speed * std::abs(leg.direction.z()) > vertical)
            leg.limits.speed = vertical / std::abs(leg.direction.z());
        legs_.push_back(leg);
    }
}

void FlyThroughPlanner::measure_corners() {
    const VehicleLimits& v = wish_.vehicle;
    corners_.resize(wish_.waypoints.size());
    for (std::size_t i = 1; i + 1 < corners_.size(); ++i) {
        FlownCorner& corner = corners_[i];
        const FlownLeg &in = legs_[i - 1], &out = legs_[i];
        corner.half_sine = (out.direction - in.direction).norm() / 2;
        corner.angle = 2 * std::asin(std::min(1.0, corner.half_sine));
        if (wish_.waypoints[i].hold > 0 || corner.angle > sharpest_cut || in.has_course != out.has_course) continue;
        // Seen from above it may turn further than in space: on steep legs it would turn round within an instant.
        if (std::abs(std::remainder(out.heading - in.heading, 2 * std::numbers::pi)) > sharpest_cut) continue;
        const double speed = std::min(in.limits.speed, out.limits.speed);
        corner.speed = speed;
        // At least a fifth of a second, so that faint corners do not become knocks.
        const double shortest = 0.1 * speed;
        // Peaks of the acceleration, 1.5 v² sin(θ/2) / d, and of the jerk, 3 v³ sin(θ/2) / d² (FEEDS.md 2.2).
        const double gentle = std::max(1.5 * speed * speed * corner.half_sine / v.lateral,
                                       std::sqrt(3 * speed * speed * speed * corner.half_sine / v.along.jerk));
        // Half way round the curve it is 3/8 d sin(θ/2) from the waypoint.
        const double near = wish_.waypoints[i].near * 8 / 3 / std::max(corner.half_sine, 1e-9);
        corner.wanted_cut = std::min({v.corner, near, std::max(gentle, shortest)});
    }
}

void FlyThroughPlanner::share_legs() {
    constexpr double no_corner = 1e-9;  // sin(θ/2) of what is a straight line
    const VehicleLimits& v = wish_.vehicle;
    for (std::size_t i = 1; i + 1 < corners_.size(); ++i) {
        FlownCorner& corner = corners_[i];
        if (corner.speed == 0 || corner.half_sine < no_corner) continue;
        // A fifth of each leg stays straight, so that there is room to gather speed.
        corner.cut = room_for_turn(corner.wanted_cut, {0.8 * legs_[i - 1].length, corners_[i - 1].wanted_cut},
                                   {0.8 * legs_[i].length, corners_[i + 1].wanted_cut});
        const double d = corner.cut, s = corner.half_sine;
        corner.speed =
            std::min({corner.speed, std::sqrt(v.lateral * d / (1.5 * s)), std::cbrt(v.along.jerk * d * d / (3 * s))});
    }
}

// At the waypoint: as long as it is told to, and at least until it looks where it goes next.
void FlyThroughPlanner::stand(FlyThroughShape& shape, std::size_t at, double hold) const {
    TimedPart part;
    part.from = wish_.waypoints[at].place;
    part.heading = at == 0 ? legs_[0].heading : legs_[at - 1].heading;
    const double to = at < legs_.size() ? legs_[at].heading : part.heading;
    part.turned = std::remainder(to - part.heading, 2 * std::numbers::pi);
    part.turning_s = steepest_of_smooth_step * std::abs(part.turned) / turns_on_the_spot;
    part.seconds = std::max(hold, part.turning_s);
    if (part.seconds > 0) shape.add(part);
}

std::shared_ptr<const LocalShape> FlyThroughPlanner::lay_out(const std::vector<double>& speeds) const {
    auto shape = std::make_shared<FlyThroughShape>();
    for (std::size_t i = 0; i < legs_.size(); ++i) {
        const FlownLeg& leg = legs_[i];
        if (speeds[i] == 0) stand(*shape, i, wish_.waypoints[i].hold);
        TimedPart part;
        part.kind = TimedPart::Kind::straight;
        part.from = wish_.waypoints[i].place + corners_[i].cut * leg.direction;
        part.direction = leg.direction;
        part.heading = leg.heading;
        part.profile = SpeedProfile(speeds[i]);
        part.profile.run(straight(i), speeds[i + 1], leg.limits);
        part.seconds = part.profile.duration();
        shape->add(part);
        if (corners_[i + 1].cut == 0) continue;
        LocalMotion in, out;
        in.position = wish_.waypoints[i + 1].place - corners_[i + 1].cut * leg.direction;
        in.velocity = speeds[i + 1] * leg.direction;
        out.position = wish_.waypoints[i + 1].place + corners_[i + 1].cut * legs_[i + 1].direction;
        out.velocity = speeds[i + 1] * legs_[i + 1].direction;
        part.kind = TimedPart::Kind::corner;
        part.follows_course = leg.has_course;
        part.seconds = 2 * corners_[i + 1].cut / speeds[i + 1];
        part.corner = QuinticPiece(in, out, part.seconds);
        shape->add(part);
    }
    stand(*shape, legs_.size(), std::max(wish_.waypoints.back().hold, 1e-3));
    return shape;
}

PathPlanResult FlyThroughPlanner::plan() {
    constexpr double told_when_below = 0.5;  // of the speed that was asked for
    measure_legs();
    measure_corners();
    share_legs();
    std::vector<SpeedSection> sections;
    std::vector<double> speeds(corners_.size(), 0.0);
    for (std::size_t i = 0; i < legs_.size(); ++i) {
        sections.push_back({straight(i), legs_[i].limits});
        speeds[i] = corners_[i].speed;
        const double asked = wish_.waypoints[i].speed;
        if (legs_[i].limits.speed < asked * (1 - 1e-9))
            notes_.add(
                fmt::format("{} it goes at {:.3g} m/s instead of {:g}: limits of climb and "
                            "sink",
                            leg_called(wish_.waypoints, i), legs_[i].limits.speed, asked));
        if (i > 0 && corners_[i].speed < told_when_below * std::min(legs_[i - 1].limits.speed, legs_[i].limits.speed))
            notes_.add(corners_[i].speed > 0
                           ? fmt::format("{}, a turn of {:.0f}°: slowed to {:.3g} m/s",
                                         waypoint_called(wish_.waypoints, i),
                                         corners_[i].angle * 180 / std::numbers::pi, corners_[i].speed)
                           : fmt::format("{}: stops there", waypoint_called(wish_.waypoints, i)));
    }
    make_speeds_reachable(sections, speeds);
    return PathPlan{lay_out(speeds), notes_.take(), {}};
}

}  // namespace

PathPlanResult plan_fly_through(const WaypointWish& wish) { return FlyThroughPlanner(wish).plan(); }

}  // namespace skyloop::inline motion
