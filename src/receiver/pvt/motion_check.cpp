#include "receiver/pvt/motion_check.hpp"

#include <cmath>

namespace skyloop::inline receiver {
namespace {

constexpr double averaged_s = 0.5;      // so that a knock passes
constexpr double longest_step_s = 1.5;  // over which a change of velocity says how it came about

}  // namespace

MotionLimits motion_limits(const ReceiverSettings& settings) {
    return settings.dynamic_limits ? motion_limits(settings.dynamic_model, settings.airborne_ceiling) : MotionLimits{};
}

void MotionCheck::follow(GpsTime time, const Eigen::Vector3d& velocity) {
    const double dt = time_ ? difference(time, *time_).value() : 0;
    if (dt > 0 && dt <= longest_step_s)
        acceleration_ += (1 - std::exp(-dt / averaged_s)) * ((velocity - velocity_) / dt - acceleration_);
    else
        acceleration_.setZero();
    time_ = time;
    velocity_ = velocity;
}

bool MotionCheck::passes(const MotionLimits& limits, GpsTime time, Metres height, const Eigen::Vector3d& velocity) {
    follow(time, velocity);
    return height <= limits.height && std::hypot(velocity.x(), velocity.y()) <= limits.horizontal_speed.value() &&
           std::abs(velocity.z()) <= limits.vertical_speed.value() && acceleration_.norm() <= limits.acceleration;
}

}  // namespace skyloop::inline receiver
