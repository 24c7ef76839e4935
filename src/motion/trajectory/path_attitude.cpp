#include "motion/trajectory/path_attitude.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "base/geo/attitude.hpp"
#include "detail/smooth_step.hpp"

namespace skyloop::inline motion {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

// Of the shorter way round, rad.
Vector3d rotation_vector(const Quaterniond& q) {
    const double sine = q.vec().norm();
    if (sine < 1e-12) return (q.w() < 0 ? -2 : 2) * q.vec();
    const double angle = 2 * std::atan2(sine, std::abs(q.w()));
    return (q.w() < 0 ? -angle : angle) / sine * q.vec();
}

Quaterniond rotation(const Vector3d& vector) {
    const double angle = vector.norm();
    if (angle < 1e-12) return Quaterniond(1, vector.x() / 2, vector.y() / 2, vector.z() / 2).normalized();
    return Quaterniond(Eigen::AngleAxisd(angle, vector / angle));
}

// The body's rate of a rotation vector that changes by `slope` a second: the right Jacobian of the rotation group
// (Barfoot, State Estimation for Robotics, 7.1.5).
Vector3d body_rate(const Vector3d& vector, const Vector3d& slope) {
    const double angle = vector.norm();
    const Vector3d once = vector.cross(slope), twice = vector.cross(once);
    if (angle < 1e-4) return slope - once / 2 + twice / 6;
    const double square = angle * angle;
    return slope - (1 - std::cos(angle)) / square * once + (angle - std::sin(angle)) / (square * angle) * twice;
}

// The change of the rotation vector that gives this rate of the body: the inverse of body_rate().
Vector3d vector_slope(const Vector3d& vector, const Vector3d& rate) {
    const double angle = vector.norm();
    const Vector3d once = vector.cross(rate), twice = vector.cross(once);
    if (angle < 1e-4) return rate + once / 2 + twice / 12;
    return rate + once / 2 + (1 / (angle * angle) - 1 / (2 * angle * std::tan(angle / 2))) * twice;
}

}  // namespace

AttitudeCurve::AttitudeCurve(std::vector<AttitudeKnot> knots) : knots_(std::move(knots)) {
    const std::size_t count = knots_.size();
    rates_.assign(count, Vector3d::Zero());
    const auto leads_on = [&](std::size_t i) { return i + 1 < count && !knots_[i + 1].jump; };
    const auto rate_after = [&](std::size_t i) -> Vector3d {
        return rotation_vector(knots_[i].body_to_ecef.conjugate() * knots_[i + 1].body_to_ecef) /
               (knots_[i + 1].time - knots_[i].time);
    };
    for (std::size_t i = 0; i < count; ++i) {
        const bool from = i > 0 && leads_on(i - 1), on = leads_on(i);
        if (from && on) {
            const double before = knots_[i].time - knots_[i - 1].time, after = knots_[i + 1].time - knots_[i].time;
            rates_[i] = (after * rate_after(i - 1) + before * rate_after(i)) / (before + after);
        } else if (from || on) {
            rates_[i] = rate_after(on ? i : i - 1);
        }
    }
}

BodyTurn AttitudeCurve::at(double time) const {
    const auto after = std::upper_bound(knots_.begin(), knots_.end(), time,
                                        [](double value, const AttitudeKnot& knot) { return value < knot.time; });
    if (after == knots_.begin()) return {knots_.front().body_to_ecef, Vector3d::Zero()};
    const AttitudeKnot& from = *std::prev(after);
    if (after == knots_.end() || after->jump) {
        const bool at_last = after == knots_.end() && time == from.time;
        return {from.body_to_ecef, at_last ? rates_.back() : Vector3d(Vector3d::Zero())};
    }
    constexpr double widest = 2 * std::numbers::pi / 3;
    const double h = after->time - from.time, u = (time - from.time) / h;
    const Vector3d whole = rotation_vector(from.body_to_ecef.conjugate() * after->body_to_ecef);
    if (whole.norm() > widest) return {from.body_to_ecef * rotation(u * whole), whole / h};
    const auto index = static_cast<std::size_t>(after - knots_.begin());
    const Vector3d left = h * rates_[index - 1], right = h * vector_slope(whole, rates_[index]);
    const double u2 = u * u, u3 = u2 * u;
    const Vector3d vector = (u - 2 * u2 + u3) * left + (3 * u2 - 2 * u3) * whole + (u3 - u2) * right;
    const Vector3d slope = (1 - 4 * u + 3 * u2) * left + (6 * u - 6 * u2) * whole + (3 * u2 - 2 * u) * right;
    return {from.body_to_ecef * rotation(vector), body_rate(vector, slope) / h};
}

namespace {

constexpr double weight_mps2 = 9.80665;  // m/s²
constexpr double in_radians = std::numbers::pi / 180;

struct AcrossAndAlong {
    double right = 0, up = 0;             // acceleration, m/s²
    double ground_speed = 0, climbs = 0;  // m/s
    double ahead = 1;                     // of the ground speed along the heading; −1: backwards
};

AcrossAndAlong in_axes_of_heading(const VehicleMotion& motion) {
    const double s = std::sin(motion.heading.rad()), c = std::cos(motion.heading.rad());
    const double ground_speed = std::hypot(motion.velocity.x(), motion.velocity.y());
    const double along = motion.velocity.x() * s + motion.velocity.y() * c;
    return {motion.acceleration.x() * c - motion.acceleration.y() * s, motion.acceleration.z(), ground_speed,
            motion.velocity.z(), ground_speed > 0 ? along / ground_speed : 1};
}

// The slope of the way, which standing vehicles do not have: it fades in between no speed and a walking pace. It is
// that of the nose where it goes ahead within 60°, of the tail where it goes backwards, and goes over from one to the
// other.
double slope_of(const AcrossAndAlong& m) {
    constexpr double walking_mps = 1;
    const double speed = std::hypot(m.ground_speed, m.climbs);
    const double slope = smooth_step(speed / walking_mps).value * std::atan2(m.climbs, m.ground_speed);
    return slope * (2 * smooth_step(std::clamp(m.ahead + 0.5, 0.0, 1.0)).value - 1);
}

Attitude banked(const AcrossAndAlong& m, const VehicleMotion& motion) {
    constexpr double steepest = 60 * in_radians, angle_of_attack = 3 * in_radians;
    constexpr double lifts_off_mps = 10;
    const double bank = std::clamp(std::atan2(m.right, weight_mps2 + m.up), -steepest, steepest);
    const double attack = angle_of_attack * smooth_step(m.ground_speed / lifts_off_mps).value;
    return Attitude::roll_pitch_yaw(Angle::radians(bank), Angle::radians(slope_of(m) + attack), motion.heading);
}

// Thrust carries the weight, accelerates and overcomes the drag; it points along the body's upward axis.
Attitude leaning_with_thrust(const VehicleMotion& motion) {
    constexpr double drag_per_s = 0.1;                  // ours: 6° of lean at 10 m/s, as small multirotors show
    constexpr double least_thrust = 0.2 * weight_mps2;  // whatever it is asked for, it does not turn over
    Eigen::Vector3d thrust = motion.acceleration + drag_per_s * motion.velocity + Eigen::Vector3d(0, 0, weight_mps2);
    thrust.z() = std::max(thrust.z(), least_thrust);
    const Eigen::Vector3d down = Eigen::Vector3d(-thrust.y(), -thrust.x(), thrust.z()).normalized();  // in NED
    const Eigen::Vector3d ahead(std::cos(motion.heading.rad()), std::sin(motion.heading.rad()), 0);
    const Eigen::Vector3d right = down.cross(ahead).normalized();
    Eigen::Matrix3d body_to_ned;
    body_to_ned << right.cross(down), right, down;
    return Attitude(Eigen::Quaterniond(body_to_ned));
}

Attitude leaning_outward(const AcrossAndAlong& m, const VehicleMotion& motion, double degrees_per_g, double pitch) {
    const double roll = -degrees_per_g * in_radians * m.right / weight_mps2;
    return Attitude::roll_pitch_yaw(Angle::radians(roll), Angle::radians(pitch), motion.heading);
}

}  // namespace

Attitude attitude_of_vehicle(VehicleClass kind, const VehicleMotion& motion) {
    constexpr double car_lean = 4, boat_lean = 15;  // degrees per g
    const AcrossAndAlong m = in_axes_of_heading(motion);
    switch (kind) {
        case VehicleClass::plane:
            return banked(m, motion);
        case VehicleClass::multirotor:
            return leaning_with_thrust(motion);
        case VehicleClass::rover:
        case VehicleClass::car:
            return leaning_outward(m, motion, car_lean, slope_of(m));
        case VehicleClass::boat:
            return leaning_outward(m, motion, boat_lean, 0);  // it pitches with the waves, not with its heave
        case VehicleClass::rocket:
            return Attitude::roll_pitch_yaw({}, Angle::degrees(90), motion.heading);
        case VehicleClass::fixed:
        case VehicleClass::pedestrian:
        case VehicleClass::balloon:
            break;
    }
    return Attitude::roll_pitch_yaw({}, {}, motion.heading);
}

namespace {

using Samples = std::span<const MotionSample>;

constexpr double half_turn = std::numbers::pi;

// Roll, pitch, yaw in rad; the yaw counts on beyond half turns.
using EulerAngles = Eigen::Vector3d;

double speed_over_ground(const MotionSample& sample) { return sample.velocity.head<2>().norm(); }

// Where the vehicle looks by its course, and whether it drives backwards.
class YawByCourse {
public:
    YawByCourse(VehicleClass vehicle, std::optional<double> yaw)
        : traits_(traits_of(vehicle)),
          may_reverse_(vehicle == VehicleClass::car || vehicle == VehicleClass::rover || vehicle == VehicleClass::boat),
          yaw_(yaw) {}

    // Counts on from the yaw before.
    double next(const MotionSample& sample) {
        constexpr double fastest_reverse_mps = 8, turned_round = 2 * half_turn / 3;
        const double speed = speed_over_ground(sample);
        if (speed < traits_.course_gate.value() || speed == 0) {
            stood_ = true;
            return yaw_.value_or(0);
        }
        const double course = std::atan2(sample.velocity.y(), sample.velocity.x());
        if (!yaw_) yaw_ = course;
        if (std::exchange(stood_, false))
            reverse_ = may_reverse_ && std::abs(std::remainder(course - *yaw_, 2 * half_turn)) > turned_round;
        if (speed > fastest_reverse_mps) reverse_ = false;
        const double towards = course + (reverse_ ? half_turn : 0);
        *yaw_ += std::remainder(towards - *yaw_, 2 * half_turn);
        return *yaw_;
    }

private:
    const VehicleTraits& traits_;
    bool may_reverse_, reverse_ = false, stood_ = true;
    std::optional<double> yaw_;
};

// As a vehicle with this motion stands. Below the gate of its class the motion tells nothing; a multirotor's thrust
// carries it at any speed.
EulerAngles angles_of(const MotionSample& sample, double yaw, VehicleClass vehicle) {
    constexpr double steepest_road_deg = 20;
    const bool hovers = vehicle == VehicleClass::multirotor;
    VehicleMotion motion;
    motion.heading = Angle::radians(yaw);
    if (hovers || speed_over_ground(sample) >= traits_of(vehicle).course_gate.value()) {
        motion.velocity = {sample.velocity.y(), sample.velocity.x(), -sample.velocity.z()};
        motion.acceleration = {sample.acceleration.y(), sample.acceleration.x(), -sample.acceleration.z()};
    }
    const Attitude stands = attitude_of_vehicle(vehicle, motion);
    const double steepest = Angle::degrees(steepest_road_deg).rad();
    const bool on_ground = vehicle == VehicleClass::car || vehicle == VehicleClass::rover;
    const double pitch = stands.pitch().rad(), turned = std::remainder(stands.yaw().rad() - yaw, 2 * half_turn);
    return {stands.roll().rad(), on_ground ? std::clamp(pitch, -steepest, steepest) : pitch, yaw + turned};
}

// First order, forwards and then backwards, which takes the lag out again.
void low_pass(std::span<EulerAngles> angles, double step) {
    constexpr double time_constant_s = 0.4;
    const double part = 1 - std::exp(-step / time_constant_s);
    for (std::size_t i = 1; i < angles.size(); ++i)
        angles[i] = angles[i - 1] + part * (angles[i] - angles[i - 1]);
    for (std::size_t i = angles.size(); i-- > 1;)
        angles[i - 1] = angles[i] + part * (angles[i - 1] - angles[i]);
}

void keep_within_limits(std::span<EulerAngles> angles, double step, VehicleClass vehicle) {
    constexpr double roll_rate_deg = 90;
    const VehicleTraits& traits = traits_of(vehicle);
    const double bank = traits.bank_limit.rad(), turn = traits.turn_rate_limit.rad() * step;
    const double roll = Angle::degrees(roll_rate_deg).rad() * step;
    for (std::size_t i = 0; i < angles.size(); ++i) {
        angles[i].x() = std::clamp(angles[i].x(), -bank, bank);
        if (vehicle == VehicleClass::multirotor) angles[i].y() = std::clamp(angles[i].y(), -bank, bank);
        if (i == 0) continue;
        angles[i].x() = std::clamp(angles[i].x(), angles[i - 1].x() - roll, angles[i - 1].x() + roll);
        angles[i].z() = std::clamp(angles[i].z(), angles[i - 1].z() - turn, angles[i - 1].z() + turn);
    }
}

void stand_stretch(Samples samples, VehicleClass vehicle, std::optional<Angle> heading,
                   std::vector<AttitudeKnot>& knots) {
    const double gate = traits_of(vehicle).course_gate.value();
    if (!heading && vehicle != VehicleClass::fixed) {
        const auto first = std::find_if(samples.begin(), samples.end(),
                                        [&](const MotionSample& s) { return speed_over_ground(s) >= gate; });
        if (first != samples.end()) heading = Angle::radians(std::atan2(first->velocity.y(), first->velocity.x()));
    }
    YawByCourse course(vehicle, heading ? std::optional(heading->rad()) : std::nullopt);
    std::vector<EulerAngles> angles;
    angles.reserve(samples.size());
    for (const MotionSample& sample : samples) {
        const double yaw = vehicle == VehicleClass::fixed ? heading.value_or(Angle()).rad() : course.next(sample);
        angles.push_back(angles_of(sample, yaw, vehicle));
    }
    const double step = samples.size() > 1 ? samples[1].time - samples[0].time : 1;
    keep_within_limits(angles, step, vehicle);
    low_pass(angles, step);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const auto attitude = Attitude::roll_pitch_yaw(Angle::radians(angles[i].x()), Angle::radians(angles[i].y()),
                                                       Angle::radians(angles[i].z()));
        knots.push_back({samples[i].time, body_to_ecef(attitude, samples[i].place), i == 0 && !knots.empty()});
    }
}

}  // namespace

std::vector<AttitudeKnot> attitude_from_motion(Samples samples, VehicleClass vehicle, std::optional<Angle> heading) {
    std::vector<AttitudeKnot> knots;
    knots.reserve(samples.size());
    for (std::size_t begin = 0; begin < samples.size();) {
        std::size_t end = begin + 1;
        while (end < samples.size() && !samples[end].jump)
            ++end;
        stand_stretch(samples.subspan(begin, end - begin), vehicle, heading, knots);
        begin = end;
    }
    return knots;
}

}  // namespace skyloop::inline motion
