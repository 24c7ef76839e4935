#include "motion/trajectory/generated_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "detail/knot_curve.hpp"
#include "detail/smooth_step.hpp"
#include "detail/steered_parts.hpp"
#include "detail/waypoint_parts.hpp"

namespace skyloop::inline motion {
namespace {

// How an angle changes where a path is left; rad/s, rad/s².
struct AngleChange {
    double rate = 0, bend = 0;
};
struct AngleChanges {
    AngleChange heading, roll, pitch;
};

AngleChange angle_change(const LocalShape& shape, double t, double LocalMotion::*angle) {
    constexpr double step_s = 1e-3;
    const double now = shape.at(t).*angle;
    const double before = std::remainder(now - shape.at(t - step_s).*angle, 2 * std::numbers::pi),
                 after = std::remainder(shape.at(t + step_s).*angle - now, 2 * std::numbers::pi);
    return {(before + after) / (2 * step_s), (after - before) / (step_s * step_s)};
}

bool is_still(const AngleChanges& left) {
    constexpr double least_rate = 1e-6, least_bend = 1e-3;  // above what differences leave of none
    for (const AngleChange& change : {left.heading, left.roll, left.pitch})
        if (std::abs(change.rate) > least_rate || std::abs(change.bend) > least_bend) return false;
    return true;
}

// By what an angle that was left in its motion goes on, until that is lost. t: s
double coasted_angle(const AngleChange& left, double t, double seconds) {
    constexpr double longest_s = 4;  // a longer joint would swing it far out of its way, and back
    const double over = std::min(seconds, longest_s), u = std::min(t / over, 1.0), v = 1 - u;
    // Of the fifth degree, with a rate and an acceleration of one at the beginning, and at rest in the end.
    const double by_rate = u * v * v * v * (1 + 3 * u), by_bend = u * u * v * v * v / 2;
    return over * (by_rate * left.rate + over * by_bend * left.bend);
}

// Between two paths, of which the next begins at rest. Roll, pitch and heading go over smoothly.
class BlendShape : public LocalShape {
public:
    BlendShape(const LocalMotion& from, const LocalMotion& to, const AngleChanges& left, double seconds)
        : from_(from), to_(to), left_(left), piece_(from, to, seconds) {}
    [[nodiscard]] double duration() const override { return piece_.seconds(); }
    [[nodiscard]] const LocalMotion& from() const { return from_; }
    [[nodiscard]] const LocalMotion& to() const { return to_; }
    [[nodiscard]] LocalMotion at(double t) const override {
        const double inside = std::clamp(t, 0.0, duration());
        LocalMotion m = piece_.at(inside);
        const double part = smooth_step(inside / duration()).value;
        const auto coasted = [&](const AngleChange& left) { return coasted_angle(left, inside, duration()); };
        m.heading = from_.heading + part * std::remainder(to_.heading - from_.heading, 2 * std::numbers::pi) +
                    coasted(left_.heading);
        m.roll = from_.roll + part * (to_.roll - from_.roll) + coasted(left_.roll);
        m.pitch = from_.pitch + part * (to_.pitch - from_.pitch) + coasted(left_.pitch);
        return m;
    }

private:
    LocalMotion from_, to_;
    AngleChanges left_;
    QuinticPiece piece_;
};

struct BlendLimits {
    SpeedLimits along;
    double climb, sink;  // m/s
    double turn;         // rad/s
    double aside;        // of the straight way, m
};

bool keeps_limits(const BlendShape& blend, const BlendLimits& limits) {
    constexpr int samples = 64;
    const double step = blend.duration() / samples;
    LocalMotion before = blend.at(0);
    for (int i = 1; i <= samples; ++i) {
        const LocalMotion m = blend.at(blend.duration() * i / samples);
        const double jerk = (m.acceleration - before.acceleration).norm() / step;
        const double turn = std::abs(m.heading - before.heading) / step;
        if (m.velocity.norm() > limits.along.speed || m.acceleration.norm() > limits.along.acceleration ||
            jerk > limits.along.jerk || turn > limits.turn)
            return false;
        if (m.velocity.z() > limits.climb || -m.velocity.z() > limits.sink) return false;
        if (distance_from_leg(m.position, blend.from().position, blend.to().position) > limits.aside) return false;
        before = m;
    }
    return true;
}

// What is joined, and as what it stands before and after.
struct Joint {
    LocalMotion from, to;
    AngleChanges left;  // how `from` turns
    VehicleClass leaves, enters;
    VehicleLimits vehicle;  // by whose limits
    bool to_stop = false;   // ahead of where it was left, in the middle of its motion
};

// What comes faster than the limits is let go at the pace it has.
BlendLimits limits_of(const Joint& joint) {
    constexpr double slack = 1.02, pushed_s = 1, least_aside_m = 10;
    const auto& [from, to, left, leaves, enters, vehicle, to_stop] = joint;
    // Waves and gusts that push it up or down when it is left do so for a while.
    const double pushed = std::abs(from.acceleration.z()) * pushed_s;
    const double rises = std::max(from.velocity.z(), to.velocity.z()) + pushed,
                 falls = std::max(-from.velocity.z(), -to.velocity.z()) + pushed;
    BlendLimits limits{vehicle.along, 0, 0, 0, 0};
    limits.along.speed = slack * std::max({vehicle.along.speed, from.velocity.norm(), to.velocity.norm()});
    limits.along.acceleration =
        slack * std::max({vehicle.along.acceleration, from.acceleration.norm(), to.acceleration.norm()});
    // A turn that is left ends as others do: as fast as its lateral acceleration comes and goes.
    if (vehicle.turn_ramp > 0)
        limits.along.jerk = std::max(vehicle.along.jerk, steepest_of_smooth_step * vehicle.lateral / vehicle.turn_ramp);
    limits.climb = slack * std::max(vehicle.climb, rises);
    limits.sink = slack * std::max(vehicle.sink, falls);
    // The acceleration of a gust, kept over a long way, would lead far round.
    limits.aside = least_aside_m + (to.position - from.position).norm() / 3 +
                   from.velocity.norm() * speed_change_time(from.velocity.norm(), vehicle.along);
    limits.turn = std::max(turns_on_the_spot, slack * std::abs(left.heading.rate));
    // What pushes it when it is left lasts until it has come to rest.
    if (to_stop) limits.climb = limits.sink = limits.aside = std::numeric_limits<double>::infinity();
    return limits;
}

// What it sways up and down when it is left does not count.
bool is_too_steep(const Joint& joint) {
    constexpr double upright = 85 * std::numbers::pi / 180, little_m = 1, sways_s = 5;
    if (joint.vehicle.steepest >= upright) return false;
    const Eigen::Vector3d way = joint.to.position - joint.from.position;
    const double swayed = little_m + sways_s * std::abs(joint.from.velocity.z());
    return std::abs(way.z()) > swayed + std::tan(joint.vehicle.steepest) * way.head<2>().norm();
}

// The shortest of a row of times, each a tenth longer than the one before, in which the limits are kept; 0: none.
double blend_seconds(const Joint& joint) {
    // A rocket lies down by 90°, at the pace of a turn on the spot.
    constexpr double as_it_is_s = 0.5, other_vehicle_s = 2;
    const double shortest_s = joint.leaves == joint.enters ? as_it_is_s : other_vehicle_s;
    constexpr double longest_s = 1e5, longer = 1.1;
    if (is_too_steep(joint)) return 0;
    const BlendLimits limits = limits_of(joint);
    for (double seconds = shortest_s; seconds < longest_s; seconds *= longer)
        if (keeps_limits(BlendShape(joint.from, joint.to, joint.left, seconds), limits)) return seconds;
    return 0;
}

class SequenceShape : public LocalShape {
public:
    void add(std::shared_ptr<const LocalShape> shape, double seconds, VehicleClass from, VehicleClass to) {
        parts_.push_back({ends_, seconds, std::move(shape), from, to});
        ends_ += seconds;
    }
    void repeat() { repeats_ = true; }
    [[nodiscard]] double duration() const override {
        if (repeats_) return endless;
        return ends_;
    }
    [[nodiscard]] LocalMotion at(double t) const override {
        t = within(t);
        const Part& part = part_at(t);
        return part.shape->at(t - part.begins);
    }
    [[nodiscard]] std::optional<Standing> standing(double t) const override {
        t = within(t);
        const Part& part = part_at(t);
        const bool changes = part.from != part.to;
        return Standing{part.from, part.to, changes ? smooth_step((t - part.begins) / part.seconds).value : 0};
    }

private:
    struct Part {
        double begins, seconds;
        std::shared_ptr<const LocalShape> shape;
        VehicleClass from, to;
    };
    [[nodiscard]] double within(double t) const {
        if (repeats_ && t > ends_) t = std::fmod(t, ends_);
        return std::clamp(t, 0.0, ends_);
    }
    // t: as of within()
    [[nodiscard]] const Part& part_at(double t) const {
        const auto after = std::upper_bound(parts_.begin() + 1, parts_.end(), t,
                                            [](double value, const Part& part) { return value < part.begins; });
        return *std::prev(after);
    }

    std::vector<Part> parts_;
    double ends_ = 0;
    bool repeats_ = false;
};

bool alike(const LocalMotion& a, const LocalMotion& b) {
    constexpr double near_m = 1e-6, near_rad = 1e-9;
    return (a.position - b.position).norm() < near_m && (a.velocity - b.velocity).norm() < near_m &&
           (a.acceleration - b.acceleration).norm() < near_m &&
           std::abs(std::remainder(a.heading - b.heading, 2 * std::numbers::pi)) < near_rad &&
           std::abs(a.roll - b.roll) < near_rad && std::abs(a.pitch - b.pitch) < near_rad;
}

// Where a path that is left in the middle of its motion comes to rest.
LocalMotion rest_after(const LocalMotion& moving, const SpeedLimits& limits) {
    LocalMotion rest = moving;
    rest.position += moving.velocity * speed_change_time(moving.velocity.norm(), limits);
    rest.velocity.setZero();
    rest.acceleration.setZero();
    return rest;
}

bool rests_level(const LocalMotion& m) {
    constexpr double still = 1e-6, level = 1e-9;
    return m.velocity.norm() < still && m.acceleration.norm() < still && std::abs(m.roll) < level &&
           std::abs(m.pitch) < level;
}

// So little that nobody steers for it.
bool is_nudge(const LocalMotion& from, const LocalMotion& to) {
    constexpr double little_m = 1, little_turn = 10 * std::numbers::pi / 180;
    return (to.position - from.position).norm() < little_m &&
           std::abs(std::remainder(to.heading - from.heading, 2 * std::numbers::pi)) < little_turn;
}

class SequencePlanner {
public:
    SequencePlanner(const std::vector<SequenceStep>& steps, const VehicleLimits& vehicle, bool loop)
        : steps_(steps), vehicle_(vehicle), loop_(loop) {}
    PathPlanResult plan();

private:
    [[nodiscard]] double seconds(std::size_t i) const {
        return std::min(steps_[i].seconds, steps_[i].shape->duration());
    }
    std::string add_blend(const Joint& joint, const std::string& where);
    std::string add_stop(Joint& joint, const std::string& where);
    std::string join(const Joint& joint, const std::string& from_to);
    std::string steer(const Joint& joint, const std::string& from_to);
    [[nodiscard]] const VehicleLimits& vehicle_between(const SequenceStep& left, const SequenceStep& entered) const;
    [[nodiscard]] AngleChanges turns_when_left(std::size_t i) const;
    std::string leave(std::size_t i);

    const std::vector<SequenceStep>& steps_;
    VehicleLimits vehicle_;
    bool loop_;
    std::shared_ptr<SequenceShape> shape_ = std::make_shared<SequenceShape>();
    std::vector<std::string> notes_;
};

// A mistake when there is no way, else nothing.
std::string SequencePlanner::add_blend(const Joint& joint, const std::string& where) {
    const auto& [from, to, left, leaves, enters, vehicle, to_stop] = joint;
    if (leaves == enters && is_still(left) && alike(from, to)) return {};
    const double seconds = blend_seconds(joint);
    const double way = (to.position - from.position).norm();
    if (seconds == 0)
        return fmt::format(
            "{}no way of {:.0f} m keeps the limits of {:g} m/s, {:g} m/s², {:g} m/s³ and a slope of {:.0f}°; expected "
            "a step that ends by itself (laps), a way less steep, or higher limits",
            where, way, vehicle.along.speed, vehicle.along.acceleration, vehicle.along.jerk,
            vehicle.steepest * 180 / std::numbers::pi);
    shape_->add(std::make_shared<BlendShape>(from, to, left, seconds), seconds, leaves, enters);
    notes_.push_back(fmt::format("{}joined by a curve of {:.1f} s over {:.1f} m", where, seconds, way));
    return {};
}

// To rest ahead of where it is left; nearer or farther where the curve that leads there would be too fast, as out of a
// narrow circle. @param joint gets its end
std::string SequencePlanner::add_stop(Joint& joint, const std::string& where) {
    joint.to_stop = true;
    joint.enters = joint.leaves;
    const Eigen::Vector3d ahead = rest_after(joint.from, joint.vehicle.along).position - joint.from.position;
    std::string mistake;
    for (const double share : {1.0, 0.5, 0.25, 2.0}) {
        joint.to.position = joint.from.position + share * ahead;
        const std::string refused = add_blend(joint, where);
        if (refused.empty()) return {};
        if (mistake.empty()) mistake = refused;
    }
    return mistake;
}

// By one curve, or by one to a stop and another one from there: who leaves a circle away from where the next path
// begins would swing out too fast.
std::string SequencePlanner::join(const Joint& joint, const std::string& from_to) {
    if (joint.vehicle.is_steered()) return steer(joint, from_to);
    const std::string mistake = add_blend(joint, from_to + ": ");
    if (mistake.empty() || joint.from.velocity.norm() == 0) return mistake;
    Joint stop = joint, on = joint;
    stop.to = rest_after(joint.from, joint.vehicle.along);
    if (!add_stop(stop, from_to + ", to a stop: ").empty()) return mistake;
    on.from = stop.to, on.left = {};
    return add_blend(on, from_to + ", from the stop on: ");
}

// Planes, boats and cars come to rest and go round corners to where the next path begins: they neither slide sideways
// nor turn where they stand.
std::string SequencePlanner::steer(const Joint& joint, const std::string& from_to) {
    if (joint.leaves == joint.enters && is_still(joint.left) && alike(joint.from, joint.to)) return {};
    Joint stop = joint, on = joint;
    on.left = {};
    if (!rests_level(joint.from) || !is_still(joint.left)) {
        stop.to = rest_after(joint.from, joint.vehicle.along);
        stop.to.roll = stop.to.pitch = 0;
        if (std::string mistake = add_stop(stop, from_to + ", to a stop: "); !mistake.empty()) return mistake;
        on.from = stop.to;
    }
    if (is_nudge(on.from, on.to)) return add_blend(on, from_to + ": ");
    const auto way = steered_joint(on.from, on.to, joint.vehicle);
    if (!way)
        return fmt::format(
            "{}: a {}, which does not turn where it stands, finds no way of {:.0f} m, {:+.0f} m of height and a turn "
            "of {:.0f}°; expected a step with waypoints that lead there, or places further apart or less steep",
            from_to, vehicle_name(joint.vehicle.kind), (on.to.position - on.from.position).head<2>().norm(),
            on.to.position.z() - on.from.position.z(),
            std::abs(std::remainder(on.to.heading - on.from.heading, 2 * std::numbers::pi)) * 180 / std::numbers::pi);
    shape_->add(way, way->duration(), joint.leaves, joint.enters);
    notes_.push_back(fmt::format("{}: joined by a way round corners of {:.1f} s", from_to, way->duration()));
    on.from = way->at(way->duration());
    on.leaves = joint.enters;
    return add_blend(on, from_to + ", to its lean: ");
}

// That of the sequence, unless both steps are another one's.
const VehicleLimits& SequencePlanner::vehicle_between(const SequenceStep& left, const SequenceStep& entered) const {
    const bool own = left.vehicle.kind == entered.vehicle.kind && left.vehicle.kind != vehicle_.kind;
    return own ? left.vehicle : vehicle_;
}

// A path that has ended is at rest.
AngleChanges SequencePlanner::turns_when_left(std::size_t i) const {
    const LocalShape& shape = *steps_[i].shape;
    const double t = seconds(i);
    if (t >= shape.duration()) return {};
    return {angle_change(shape, t, &LocalMotion::heading), angle_change(shape, t, &LocalMotion::roll),
            angle_change(shape, t, &LocalMotion::pitch)};
}

// From the end of step i on.
std::string SequencePlanner::leave(std::size_t i) {
    const LocalMotion end = steps_[i].shape->at(seconds(i));
    const bool last = i + 1 == steps_.size();
    const std::size_t next = last ? 0 : i + 1;
    const SequenceStep& step = steps_[i];
    Joint joint{end, end, turns_when_left(i), step.vehicle.kind, step.vehicle.kind, vehicle_between(step, step)};
    if (last && !loop_) {
        joint.to = rest_after(end, joint.vehicle.along);
        return add_stop(joint, fmt::format("step {} is left before its end: ", i + 1));
    }
    joint.to = steps_[next].shape->at(0);
    joint.enters = steps_[next].vehicle.kind;
    joint.vehicle = vehicle_between(step, steps_[next]);
    return join(joint, fmt::format("from step {} to {}", i + 1, next + 1));
}

PathPlanResult SequencePlanner::plan() {
    for (std::size_t i = 0; i < steps_.size(); ++i) {
        const bool finite = std::isfinite(seconds(i));
        if (!finite && (loop_ || i + 1 < steps_.size()))
            return tl::unexpected(fmt::format("step {} has no end; expected duration_s or laps", i + 1));
        shape_->add(steps_[i].shape, seconds(i), steps_[i].vehicle.kind, steps_[i].vehicle.kind);
        if (!finite) break;
        if (const std::string mistake = leave(i); !mistake.empty()) return tl::unexpected(mistake);
    }
    if (loop_) shape_->repeat();
    return PathPlan{shape_, notes_, {}};
}

}  // namespace

PathPlanResult plan_sequence(const std::vector<SequenceStep>& steps, const VehicleLimits& vehicle, bool loop) {
    if (steps.empty()) return tl::unexpected(std::string("has no steps; expected one or more"));
    return SequencePlanner(steps, vehicle, loop).plan();
}

}  // namespace skyloop::inline motion
