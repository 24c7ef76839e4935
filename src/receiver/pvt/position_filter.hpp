/// The receiver's filter: what it makes of the solutions of single epochs.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "base/geo/frames.hpp"
#include "base/time/gps_time.hpp"
#include "receiver/pvt/navigation_parameters.hpp"
#include "world/flow/receiver_settings.hpp"

namespace skyloop::inline receiver {

/// What one epoch gives the filter.
struct PositionInput {
    GpsTime time;
    Position<Ecef> position;
    Metres deviation;                        ///< 1 σ of the position, three-dimensional
    std::optional<Velocity<Ecef>> velocity;  ///< by Doppler
    MetresPerSecond velocity_deviation;      ///< 1 σ, three-dimensional
};

/// What the filter says.
struct FilteredPosition {
    Position<Ecef> position;
    Velocity<Ecef> velocity;
    bool held = false;   ///< by static hold
    Seconds coasted{0};  ///< since the last solution
};

/// The reported velocity: what the Dopplers say through a first-order filter of `velocity_memory`, by which it is late
/// in a manoeuvre, and at rest of `velocity_rest_memory`; a step beyond the noise is followed as in motion.
class VelocityFilter {
public:
    /// @param deviation 1 σ, three-dimensional @param model stationary and portable ones remember longer, airborne ones
    /// less
    Velocity<Ecef> update(const FilterParameters& parameters, GpsTime time, const Velocity<Ecef>& measured,
                          MetresPerSecond deviation, DynamicModel model);
    /// Whether the last one was taken for one of a receiver at rest.
    [[nodiscard]] bool rests() const { return rests_; }
    void reset() { *this = VelocityFilter(); }

private:
    std::optional<GpsTime> time_;
    bool rests_ = false;
    Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero(), measured_ = Eigen::Vector3d::Zero();
};

/// A constant-velocity filter with the gain of its steady state: the position is carried along by the Doppler velocity
/// and drawn to the solutions of single epochs with a memory of position_memory; while it is young it averages all it
/// has had. The way between two epochs is the integral of the cubic through the last four velocities; what that leaves
/// out in a turn opens the gain, so that it does not lag. The reported position lags as the reported velocity does.
///
/// State: the position, the last velocities, how much it has averaged, and what static hold holds.
class PositionFilter {
public:
    explicit PositionFilter(const FilterParameters& parameters) : parameters_(parameters) {}
    /// Takes a solution in; times ascend.
    FilteredPosition update(const PositionInput& measured, const ReceiverSettings& settings);
    /// The position carried on without a solution; nothing once that has lasted longer than `coasting`.
    [[nodiscard]] std::optional<FilteredPosition> coast(GpsTime time);
    void reset();

private:
    [[nodiscard]] Eigen::Vector3d way(double dt, const PositionInput& input, double& unsure) const;
    double gain(double dt, double unsure, const ReceiverSettings& settings);
    void remember(const PositionInput& input, double dt);
    void start(const PositionInput& input);
    bool holds(const PositionInput& input, const Eigen::Vector3d& velocity, const ReceiverSettings& settings);
    void lag(const Eigen::Vector3d& late, double dt);
    [[nodiscard]] FilteredPosition reported(bool held) const;

    FilterParameters parameters_;
    std::optional<GpsTime> time_;
    Eigen::Vector3d position_ = Eigen::Vector3d::Zero();
    std::array<Eigen::Vector3d, 4> velocities_{};  // the newest first
    int velocity_count_ = 0;                       // evenly spaced ones
    double spacing_ = 0;                           // s
    double averaged_ = 0;                          // epochs, while young
    bool settled_ = false;                         // half of the memory has been filled
    bool interrupted_ = false;
    std::optional<Eigen::Vector3d> held_;
    Eigen::Vector3d reported_velocity_ = Eigen::Vector3d::Zero();
    Eigen::Vector3d lag_ = Eigen::Vector3d::Zero();   // of the reported position, m
    Eigen::Vector3d late_ = Eigen::Vector3d::Zero();  // what the reported velocity leaves out, m/s
    VelocityFilter velocity_filter_;
};

}  // namespace skyloop::inline receiver
