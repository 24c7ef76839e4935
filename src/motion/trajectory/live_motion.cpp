#include "detail/live_motion.hpp"

#include <algorithm>
#include <cmath>

#include "detail/least_squares.hpp"

namespace skyloop::inline motion {
namespace {

using Motion = LivePath::Motion;
using Patience = LivePath::Patience;

Eigen::Quaterniond turned(const Eigen::Quaterniond& attitude, const Eigen::Vector3d& angle) {
    const double size = angle.norm();
    if (size < 1e-12) return attitude;
    return (attitude * Eigen::Quaterniond(Eigen::AngleAxisd(size, angle / size))).normalized();
}

// With its velocity, and an acceleration that fades (FEEDS.md 3.1).
Motion coasted(const Motion& from, double fading_time, double t) {
    const double left = std::exp(-t / fading_time);
    const double gained = fading_time * (1 - left);  // integral of what is left
    Motion motion;
    motion.position = from.position + from.velocity * t + from.acceleration * fading_time * (t - gained);
    motion.velocity = from.velocity + from.acceleration * gained;
    motion.acceleration = from.acceleration * left;
    motion.turn_rate = from.turn_rate * left;
    if (from.body_to_ned) motion.body_to_ned = turned(*from.body_to_ned, from.turn_rate * gained);
    return motion;
}

// Velocity to zero in `length` s with a continuous acceleration: v·(1 − 10s³ + 15s⁴ − 6s⁵) + a·L·s(1 − s)³.
Motion faded(const Motion& from, double length, double t) {
    const double s = length > 0 ? std::min(1.0, t / length) : 1;
    const double s2 = s * s, s3 = s2 * s, s4 = s3 * s, s5 = s4 * s, s6 = s5 * s;
    const Eigen::Vector3d gain = from.acceleration * length;
    Motion motion = from;
    motion.velocity = from.velocity * (1 - 10 * s3 + 15 * s4 - 6 * s5) + gain * (s - 3 * s2 + 3 * s3 - s4);
    motion.position = from.position + length * (from.velocity * (s - 2.5 * s4 + 3 * s5 - s6) +
                                                gain * (s2 / 2 - s3 + 0.75 * s4 - 0.2 * s5));
    motion.acceleration.setZero();
    if (length > 0)
        motion.acceleration = (from.velocity * (-30 * s2 + 60 * s3 - 30 * s4)) / length +
                              from.acceleration * (1 - 6 * s + 9 * s2 - 4 * s3);
    return motion;
}

}  // namespace

Motion carried_on(const Motion& from, const Patience& patience, double after) {
    const Motion free = coasted(from, patience.fading_time, after);
    if (after <= patience.coast) return free;
    Motion slowed = faded(coasted(from, patience.fading_time, patience.coast), patience.fade - patience.coast,
                          after - patience.coast);
    slowed.turn_rate = free.turn_rate;
    slowed.body_to_ned = free.body_to_ned;
    return slowed;
}

Motion between(const Motion& from, const Motion& to, double h, double t, Velocities velocities) {
    const double u = t / h, u2 = u * u, u3 = u2 * u, u4 = u3 * u, u5 = u4 * u;
    const Eigen::Vector3d way = to.position - from.position;
    const Eigen::Vector3d v0 = h * from.velocity, v1 = h * to.velocity;
    const Eigen::Vector3d a0 = h * h * from.acceleration, a1 = h * h * to.acceleration;
    const Eigen::Vector3d c3 = 10 * way - 6 * v0 - 4 * v1 - 1.5 * a0 + 0.5 * a1;
    const Eigen::Vector3d c4 = -15 * way + 8 * v0 + 7 * v1 + 1.5 * a0 - a1;
    const Eigen::Vector3d c5 = 6 * way - 3 * v0 - 3 * v1 - 0.5 * a0 + 0.5 * a1;
    Motion motion;
    motion.position = from.position + v0 * u + a0 * (u2 / 2) + c3 * u3 + c4 * u4 + c5 * u5;
    motion.velocity = (v0 + a0 * u + 3 * c3 * u2 + 4 * c4 * u3 + 5 * c5 * u4) / h;
    motion.acceleration = (a0 + 6 * c3 * u + 12 * c4 * u2 + 20 * c5 * u3) / (h * h);
    if (velocities == Velocities::told) {
        // What the curve's way differs from the way of the velocities by, taken smoothly (10 u³ − 15 u⁴ + 6 u⁵).
        const Eigen::Vector3d left = way - (v0 + v1) / 2 - (a0 - a1) / 12;
        motion.velocity -= left * (30 * u2 - 60 * u3 + 30 * u4) / h;
        motion.acceleration -= left * (60 * u - 180 * u2 + 120 * u3) / (h * h);
    }
    motion.turn_rate = from.turn_rate + u * (to.turn_rate - from.turn_rate);
    if (from.body_to_ned && to.body_to_ned)
        motion.body_to_ned = from.body_to_ned->slerp(u, *to.body_to_ned);
    else
        motion.body_to_ned = to.body_to_ned ? to.body_to_ned : from.body_to_ned;
    return motion;
}

Motion taken_away(const Motion& difference, double length, double t) {
    if (t >= length) return {};
    Motion nothing;
    Motion start = difference;
    start.body_to_ned.reset();
    return between(start, nothing, length, t);
}

double part_left(double length, double t) {
    if (t >= length) return 0;
    const double s = std::max(0.0, t / length);
    return 1 - s * s * s * (10 - 15 * s + 6 * s * s);
}

Eigen::Vector3d slope_at_end(std::span<const double> times, std::span<const Eigen::Vector3d> values) {
    const std::size_t count = times.size();
    if (count < 2) return Eigen::Vector3d::Zero();
    const double span = times.back() - times.front();
    if (count == 2 || !(span > 0)) return (values[count - 1] - values[0]) / std::max(span, 1e-9);
    // In units of the span, so that the columns are alike in size.
    constexpr int most = 9;
    Eigen::Matrix<double, Eigen::Dynamic, 3, 0, most, 3> design(static_cast<Eigen::Index>(count), 3),
        found(static_cast<Eigen::Index>(count), 3);
    for (std::size_t i = 0; i < count; ++i) {
        const double t = (times[i] - times.back()) / span;
        design.row(static_cast<Eigen::Index>(i)) << 1, t, t * t;
        found.row(static_cast<Eigen::Index>(i)) = (values[i] - values.back()).transpose();
    }
    const Eigen::Matrix3d normal = design.transpose() * design;
    const Eigen::Matrix3d right = design.transpose() * found;
    const Eigen::Matrix3d fit = least_squares(normal, right);
    return fit.row(1).transpose() / span;
}

}  // namespace skyloop::inline motion
