#include "receiver/error_model/ground_motion.hpp"

#include <cmath>
#include <numbers>

#include "base/geo/local_frame.hpp"

namespace skyloop {
namespace {

// Within 11 km of a pole a step is no longer short against the circle of latitude.
bool is_near_pole(const Geodetic& place) { return std::abs(place.latitude.deg()) > 89.9; }

}  // namespace

GroundMotion ground_motion(const VelocityNed& velocity) {
    double course = std::atan2(velocity.east, velocity.north);
    if (course < 0) course += 2 * std::numbers::pi;
    // A tiny negative angle rounds up to a full turn, which is north again.
    if (course >= 2 * std::numbers::pi) course = 0;
    return {velocity, MetresPerSecond(std::hypot(velocity.north, velocity.east)), Angle::radians(course)};
}

GroundMotion motion_between(const TimedPosition& before, const TimedPosition& after) {
    const double dt = difference(after.time, before.time).value();
    if (dt <= 0) return {};
    const Geodetic& a = before.position;
    const Geodetic& b = after.position;
    const double h_a = a.height.above_ellipsoid.value();
    const double h_b = b.height.above_ellipsoid.value();
    const Angle latitude = (a.latitude + b.latitude) * 0.5;
    const double height = (h_a + h_b) / 2;
    const CurvatureRadii radii = curvature_radii(latitude);
    // The short way round across the antimeridian.
    const double d_longitude = std::remainder((b.longitude - a.longitude).rad(), 2 * std::numbers::pi);
    VelocityNed velocity;
    velocity.north = (radii.meridian + height) * (b.latitude - a.latitude).rad() / dt;
    velocity.east = (radii.prime_vertical + height) * std::cos(latitude.rad()) * d_longitude / dt;
    velocity.down = -(h_b - h_a) / dt;
    if (is_near_pole(a) || is_near_pole(b)) {
        const Displacement<Enu> way = LocalFrame(b).to_enu(to_ecef(b) - to_ecef(a));
        velocity.north = way.vector().y() / dt;
        velocity.east = way.vector().x() / dt;
    }
    return ground_motion(velocity);
}

GroundMotion MotionOfFixes::next(const TimedPosition& fix) {
    const GroundMotion motion = last_ ? motion_between(*last_, fix) : GroundMotion{};
    last_ = fix;
    return motion;
}

}  // namespace skyloop
