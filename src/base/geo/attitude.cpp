#include "base/geo/attitude.hpp"

#include <algorithm>
#include <cmath>

namespace skyloop {

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

}  // namespace skyloop
