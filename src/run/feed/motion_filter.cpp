#include "detail/motion_filter.hpp"

#include <cmath>

namespace skyloop::inline run {

void AxisFilter::start(double position, double sigma) {
    constexpr double start_speed = 30, start_acceleration = 10;  // 1 σ
    state_ << position, 0, 0;
    covariance_ =
        Eigen::Vector3d(sigma * sigma, start_speed * start_speed, start_acceleration * start_acceleration).asDiagonal();
}

void AxisFilter::predict(double seconds) {
    const double h = seconds, h2 = h * h, h3 = h2 * h, h4 = h3 * h, h5 = h4 * h;
    Eigen::Matrix3d step, noise;
    step << 1, h, h2 / 2,  //
        0, 1, h,           //
        0, 0, 1;
    noise << h5 / 20, h4 / 8, h3 / 6,  //
        h4 / 8, h3 / 3, h2 / 2,        //
        h3 / 6, h2 / 2, h;
    state_ = step * state_;
    covariance_ = step * covariance_ * step.transpose() + jerk_power_ * noise;
}

void AxisFilter::see(Eigen::Index which, double value, double sigma) {
    const Eigen::Vector3d column = covariance_.col(which);
    const Eigen::Vector3d gain = column / (column(which) + sigma * sigma);
    state_ += gain * (value - state_(which));
    covariance_ -= gain * column.transpose();
    covariance_ = (covariance_ + covariance_.transpose()).eval() / 2;
}

void MotionFilter::smooth(TruthSample& sample, std::int64_t time_ns) {
    constexpr double longest_silence_s = 2, farthest_m = 100;
    const Eigen::Vector3d position = sample.position.vector();
    const double step = time_ns_ ? static_cast<double>(time_ns - *time_ns_) * 1e-9 : -1;
    time_ns_ = time_ns;
    const bool goes_on = step >= 0 && step <= longest_silence_s;
    bool near = goes_on;
    Eigen::Vector3d smooth_position, smooth_velocity;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
        AxisFilter& filter = axes_[static_cast<std::size_t>(axis)];
        if (goes_on) filter.predict(step);
        near = near && std::abs(filter.position() - position(axis)) <= farthest_m;
    }
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
        AxisFilter& filter = axes_[static_cast<std::size_t>(axis)];
        if (near)
            filter.see_position(position(axis), noise_.position_m);
        else
            filter.start(position(axis), noise_.position_m);
        if (sample.velocity) filter.see_velocity(sample.velocity->vector()(axis), noise_.velocity_mps);
        smooth_position(axis) = filter.position();
        smooth_velocity(axis) = filter.velocity();
    }
    seen_ = near ? seen_ + 1 : 0;
    sample.position = Position<Ecef>(smooth_position);
    // One position alone tells no velocity.
    if (sample.velocity || seen_ >= 2) sample.velocity = Velocity<Ecef>(smooth_velocity);
}

}  // namespace skyloop::inline run
