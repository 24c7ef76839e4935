#include "motion/trajectory/shaped_path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/geo/geodetic.hpp"
#include "base/geo/local_frame.hpp"
#include "detail/smooth_step.hpp"

namespace skyloop::inline motion {

Eigen::Vector3d GeodesicPlane::to_local(const Geodetic& place) const {
    const GeodesicLeg leg = geodesic_between(origin_, place);
    const double length = leg.length.value();
    return {length * std::sin(leg.azimuth.rad()), length * std::cos(leg.azimuth.rad()),
            place.height.above_ellipsoid.value()};
}

GeodesicPlane::Placed GeodesicPlane::place(GpsTime time, const LocalMotion& motion) const {
    constexpr double nearest_m = 1;  // below it the plane and the ellipsoid differ by less than 1e-13
    const double east = motion.position.x(), north = motion.position.y();
    const double distance = std::hypot(east, north);
    const double azimuth = distance > 0 ? std::atan2(east, north) : 0;
    const GeodesicPoint point = geodesic_direct(origin_, Angle::radians(azimuth), Metres(distance));
    const double across = distance > nearest_m ? point.reduced_length.value() / distance : 1;
    // The velocity along the geodesic keeps its size; the one across it has that of the lines that draw apart.
    const double s = std::sin(azimuth), c = std::cos(azimuth);
    const double outward = motion.velocity.x() * s + motion.velocity.y() * c;
    const double clockwise = across * (motion.velocity.x() * c - motion.velocity.y() * s);
    const double end_s = std::sin(point.azimuth.rad()), end_c = std::cos(point.azimuth.rad());
    const CurvatureRadii radii = curvature_radii(point.latitude);
    const double height = motion.position.z();
    Placed placed;
    placed.north = Angle::radians(std::remainder(point.azimuth.rad() - azimuth, 2 * std::numbers::pi));
    placed.state.time = time;
    placed.state.geodetic = {point.latitude, point.longitude, {Metres(height)}};
    placed.state.position = to_ecef(placed.state.geodetic);
    // At a height the vehicle covers more metres than its shadow on the ellipsoid.
    const Velocity<Enu> velocity((outward * end_s + clockwise * end_c) * (1 + height / radii.prime_vertical),
                                 (outward * end_c - clockwise * end_s) * (1 + height / radii.meridian),
                                 motion.velocity.z());
    placed.state.velocity = LocalFrame(placed.state.geodetic).to_ecef(velocity);
    return placed;
}

namespace {

constexpr double half_window_s = 0.25;

}  // namespace

// A vehicle begins and ends at rest, and leans neither before nor after: there the window looks at what it has behind
// it, and at what it has before it.
double ShapedPath::middle_of_window(double t) const {
    constexpr double longest_s = 1;
    const double whole = shape_->duration();
    const double over = std::min(longest_s, whole / 2);
    if (!(over > 0)) return t;
    const double begun = smooth_step(t / over).value;
    const double ends = std::isfinite(whole) ? smooth_step((whole - t) / over).value : 1;
    return t - half_window_s * (1 - begun) + half_window_s * (1 - ends);
}

Attitude ShapedPath::in_motion(double t, const VehicleMotion& motion) const {
    const Standing standing = shape_->standing(t).value_or(Standing{vehicle_, vehicle_, 0});
    const Attitude from = attitude_of_vehicle(standing.from, motion);
    if (standing.from == standing.to) return from;
    return Attitude(from.body_to_ned().slerp(standing.part, attitude_of_vehicle(standing.to, motion).body_to_ned()));
}

// The mean over two windows, one after the other: the second difference of the places. One window would leave the
// turn rate with corners, since accelerations go up and down in straight lines (FEEDS.md 1.13.4: 0.3 to 0.5 s).
Attitude ShapedPath::attitude(double t, const LocalMotion& now, Angle north) const {
    const double middle = middle_of_window(t);
    VehicleMotion motion;
    motion.velocity = now.velocity;
    motion.acceleration = (shape_->at(middle + half_window_s).position - 2 * shape_->at(middle).position +
                           shape_->at(middle - half_window_s).position) /
                          (half_window_s * half_window_s);
    motion.heading = Angle::radians(now.heading);
    const Attitude in_plane = in_motion(t, motion);
    const Attitude leaning = Attitude::roll_pitch_yaw(Angle::radians(now.roll), Angle::radians(now.pitch), {});
    return Attitude(Attitude::roll_pitch_yaw({}, {}, north).body_to_ned() * in_plane.body_to_ned() *
                    leaning.body_to_ned());
}

TruthState ShapedPath::at(GpsTime time) const {
    constexpr double step_s = 1e-3;
    const double t = difference(time, start_).value();
    const LocalMotion now = shape_->at(t);
    GeodesicPlane::Placed placed = plane_.place(time, now);
    const auto attitude_at = [&](double when) { return attitude(when, shape_->at(when), placed.north); };
    const Eigen::Quaterniond before = attitude_at(t - step_s).body_to_ned();
    const Eigen::AngleAxisd turned(before.conjugate() * attitude_at(t + step_s).body_to_ned());
    Orientation orientation;
    orientation.attitude = attitude(t, now, placed.north);
    orientation.turn_rate = turned.angle() / (2 * step_s) * turned.axis();
    placed.state.orientation = orientation;
    return placed.state;
}

}  // namespace skyloop::inline motion
