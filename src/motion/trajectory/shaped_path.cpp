#include "motion/trajectory/shaped_path.hpp"

#include <algorithm>
#include <cmath>

#include "detail/smooth_step.hpp"

namespace skyloop {
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

}  // namespace skyloop
