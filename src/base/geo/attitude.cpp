#include "base/geo/attitude.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace skyloop::inline base {

Attitude Attitude::roll_pitch_yaw(Angle roll, Angle pitch, Angle yaw) {
    return Attitude(Eigen::AngleAxisd(yaw.rad(), Eigen::Vector3d::UnitZ()) *
                    Eigen::AngleAxisd(pitch.rad(), Eigen::Vector3d::UnitY()) *
                    Eigen::AngleAxisd(roll.rad(), Eigen::Vector3d::UnitX()));
}

Angle Attitude::roll() const {
    const Eigen::Quaterniond& q = body_to_ned_;
    return Angle::radians(std::atan2(2 * (q.w() * q.x() + q.y() * q.z()), 1 - 2 * (q.x() * q.x() + q.y() * q.y())));
}

Angle Attitude::pitch() const {
    const Eigen::Quaterniond& q = body_to_ned_;
    return Angle::radians(std::asin(std::clamp(2 * (q.w() * q.y() - q.z() * q.x()), -1.0, 1.0)));
}

Angle Attitude::yaw() const {
    const Eigen::Quaterniond& q = body_to_ned_;
    return Angle::radians(std::atan2(2 * (q.w() * q.z() + q.x() * q.y()), 1 - 2 * (q.y() * q.y() + q.z() * q.z())));
}

Eigen::Quaterniond ned_to_ecef(const Geodetic& place) {
    // About Earth's axis by the longitude, then the north pole's frame tipped to the latitude.
    const Eigen::Quaterniond turned(Eigen::AngleAxisd(place.longitude.rad(), Eigen::Vector3d::UnitZ()));
    const Eigen::Quaterniond tipped(
        Eigen::AngleAxisd(-place.latitude.rad() - std::numbers::pi / 2, Eigen::Vector3d::UnitY()));
    return turned * tipped;
}

}  // namespace skyloop::inline base
