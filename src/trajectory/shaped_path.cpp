#include "skyloop/trajectory/shaped_path.hpp"

#include "skyloop/trajectory/vehicle_attitude.hpp"

namespace skyloop {

Attitude ShapedPath::attitude(double t, const LocalMotion& now, Angle north) const {
    constexpr double half_window_s = 0.25;  // FEEDS.md 1.13.4: smoothed over 0.3 to 0.5 s
    VehicleMotion motion;
    motion.velocity = now.velocity;
    motion.acceleration =
        (shape_->at(t + half_window_s).velocity - shape_->at(t - half_window_s).velocity) / (2 * half_window_s);
    motion.heading = Angle::radians(now.heading);
    const Attitude in_plane = attitude_of_vehicle(vehicle_, motion);
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
