// A causal filter for positions that are coarse, noisy or without velocities.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>

#include "motion/trajectory/trajectory.hpp"

namespace skyloop::inline run {

// Position, velocity and acceleration along one axis by a Kalman filter whose jerk is white noise (FEEDS.md 1.13.2,
// step 3, without its smoother: the future is not there yet).
class AxisFilter {
public:
    // @param jerk_density its square root, m/s³/√Hz
    explicit AxisFilter(double jerk_density) : jerk_power_(jerk_density * jerk_density) {}
    // Starts anew at a position, at rest within 30 m/s.
    void start(double position, double sigma);
    void predict(double seconds);
    void see_position(double position, double sigma) { see(0, position, sigma); }
    void see_velocity(double velocity, double sigma) { see(1, velocity, sigma); }
    [[nodiscard]] double position() const { return state_(0); }
    [[nodiscard]] double velocity() const { return state_(1); }

private:
    void see(Eigen::Index which, double value, double sigma);

    double jerk_power_;
    Eigen::Vector3d state_ = Eigen::Vector3d::Zero();
    Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
};

// How good positions and velocities are, 1 σ of an axis.
struct MotionNoise {
    double position_m = 0.01;
    double velocity_mps = 0.2;
};

// Of receivers: metres of slow wander, velocities by Doppler.
inline constexpr MotionNoise receiver_noise{1.5, 0.2};

// Three axes of ECEF. After a silence of 2 s, a step back in time, or a position more than 100 m from where it was
// expected, it starts anew.
class MotionFilter {
public:
    explicit MotionFilter(MotionNoise noise) : noise_(noise) {}
    // Replaces the sample's position by the filtered one, and gives it a velocity.
    // @param time_ns of any clock that is steady
    void smooth(TruthSample& sample, std::int64_t time_ns);
    void forget() { time_ns_.reset(); }

private:
    // White jerk of a lively vehicle, m/s³/√Hz (FEEDS.md 1.13.2: fixed wing 5, multirotor 10).
    static constexpr double jerk_density = 7;
    MotionNoise noise_;
    std::array<AxisFilter, 3> axes_{AxisFilter(jerk_density), AxisFilter(jerk_density), AxisFilter(jerk_density)};
    std::optional<std::int64_t> time_ns_;
    int seen_ = 0;
};

}  // namespace skyloop::inline run
