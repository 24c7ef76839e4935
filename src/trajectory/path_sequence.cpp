#include "skyloop/trajectory/path_sequence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "quintic_piece.hpp"
#include "smooth_step.hpp"
#include "waypoint_parts.hpp"

namespace skyloop {
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

// turn: at most, rad/s
bool keeps_limits(const BlendShape& blend, const SpeedLimits& limits, double most_turn) {
    constexpr int samples = 64;
    const double step = blend.duration() / samples;
    LocalMotion before = blend.at(0);
    for (int i = 1; i <= samples; ++i) {
        const LocalMotion m = blend.at(blend.duration() * i / samples);
        const double jerk = (m.acceleration - before.acceleration).norm() / step;
        const double turn = std::abs(m.heading - before.heading) / step;
        if (m.velocity.norm() > limits.speed || m.acceleration.norm() > limits.acceleration || jerk > limits.jerk ||
            turn > most_turn)
            return false;
        before = m;
    }
    return true;
}

// What is joined, and as what it stands before and after.
struct Joint {
    LocalMotion from, to;
    AngleChanges left;  // how `from` turns
    VehicleClass leaves, enters;
};

// The shortest of a row of times, each a tenth longer than the one before, in which the limits are kept; 0: none.
double blend_seconds(const Joint& joint, const SpeedLimits& limits) {
    const auto& [from, to, left, leaves, enters] = joint;
    // A rocket lies down on its belly by 90°, at the pace of a turn on the spot.
    constexpr double as_it_is_s = 0.5, other_vehicle_s = 2;
    const double shortest_s = leaves == enters ? as_it_is_s : other_vehicle_s;
    constexpr double longest_s = 1e5, longer = 1.1, slack = 1.02;
    // What comes faster than the limits is let go at the pace it has.
    SpeedLimits allowed = limits;
    allowed.speed = slack * std::max({limits.speed, from.velocity.norm(), to.velocity.norm()});
    allowed.acceleration = slack * std::max({limits.acceleration, from.acceleration.norm(), to.acceleration.norm()});
    const double turn = std::max(turns_on_the_spot, slack * std::abs(left.heading.rate));
    for (double seconds = shortest_s; seconds < longest_s; seconds *= longer)
        if (keeps_limits(BlendShape(from, to, left, seconds), allowed, turn)) return seconds;
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

class SequencePlanner {
public:
    SequencePlanner(const std::vector<SequenceStep>& steps, const SpeedLimits& limits, bool loop)
        : steps_(steps), limits_(limits), loop_(loop) {}
    PathPlanResult plan();

private:
    [[nodiscard]] double seconds(std::size_t i) const {
        return std::min(steps_[i].seconds, steps_[i].shape->duration());
    }
    std::string add_blend(const Joint& joint, const std::string& where);
    std::string join(const Joint& joint, const std::string& from_to);
    [[nodiscard]] AngleChanges turns_when_left(std::size_t i) const;
    std::string leave(std::size_t i);

    const std::vector<SequenceStep>& steps_;
    SpeedLimits limits_;
    bool loop_;
    std::shared_ptr<SequenceShape> shape_ = std::make_shared<SequenceShape>();
    std::vector<std::string> notes_;
};

// A mistake when there is no way, else nothing.
std::string SequencePlanner::add_blend(const Joint& joint, const std::string& where) {
    const auto& [from, to, left, leaves, enters] = joint;
    if (leaves == enters && alike(from, to)) return {};
    const double seconds = blend_seconds(joint, limits_);
    const double way = (to.position - from.position).norm();
    if (seconds == 0)
        return fmt::format(
            "{}no way of {:.0f} m keeps the limits of {:g} m/s, {:g} m/s² and {:g} m/s³; expected a step that "
            "ends by itself (laps), or higher limits",
            where, way, limits_.speed, limits_.acceleration, limits_.jerk);
    shape_->add(std::make_shared<BlendShape>(from, to, left, seconds), seconds, leaves, enters);
    notes_.push_back(fmt::format("{}joined by a curve of {:.1f} s over {:.1f} m", where, seconds, way));
    return {};
}

// By one curve, or by one to a stop and another one from there: who leaves a circle away from where the next path
// begins would swing out too fast.
std::string SequencePlanner::join(const Joint& joint, const std::string& from_to) {
    const std::string mistake = add_blend(joint, from_to + ": ");
    if (mistake.empty() || joint.from.velocity.norm() == 0) return mistake;
    const LocalMotion rest = rest_after(joint.from, limits_);
    if (!add_blend({joint.from, rest, joint.left, joint.leaves, joint.leaves}, from_to + ", to a stop: ").empty())
        return mistake;
    return add_blend({rest, joint.to, {}, joint.leaves, joint.enters}, from_to + ", from the stop on: ");
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
    const VehicleClass vehicle = steps_[i].vehicle;
    const AngleChanges turns = turns_when_left(i);
    const bool last = i + 1 == steps_.size();
    if (last && !loop_)
        return add_blend({end, rest_after(end, limits_), turns, vehicle, vehicle},
                         fmt::format("step {} is left before its end: ", i + 1));
    const std::size_t next = last ? 0 : i + 1;
    return join({end, steps_[next].shape->at(0), turns, vehicle, steps_[next].vehicle},
                fmt::format("from step {} to {}", i + 1, next + 1));
}

PathPlanResult SequencePlanner::plan() {
    for (std::size_t i = 0; i < steps_.size(); ++i) {
        const bool finite = std::isfinite(seconds(i));
        if (!finite && (loop_ || i + 1 < steps_.size()))
            return tl::unexpected(fmt::format("step {} has no end; expected duration_s or laps", i + 1));
        shape_->add(steps_[i].shape, seconds(i), steps_[i].vehicle, steps_[i].vehicle);
        if (!finite) break;
        if (const std::string mistake = leave(i); !mistake.empty()) return tl::unexpected(mistake);
    }
    if (loop_) shape_->repeat();
    return PathPlan{shape_, notes_, {}};
}

}  // namespace

PathPlanResult plan_sequence(const std::vector<SequenceStep>& steps, const SpeedLimits& limits, bool loop) {
    if (steps.empty()) return tl::unexpected(std::string("has no steps; expected one or more"));
    return SequencePlanner(steps, limits, loop).plan();
}

}  // namespace skyloop
