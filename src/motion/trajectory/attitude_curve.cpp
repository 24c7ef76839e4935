#include "motion/trajectory/attitude_curve.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

namespace skyloop {
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

}  // namespace skyloop
