#include "receiver/pvt/position_filter.hpp"

#include <algorithm>
#include <cmath>

namespace skyloop::inline receiver {
namespace {

using Eigen::Vector3d;

// How far the filter may lag in a manoeuvre.
constexpr double tolerated_lag_m = 0.01;
// Standard deviations of the velocity's noise that are not taken for a manoeuvre.
constexpr double quiet_deviations = 3;
// An innovation beyond these is a jump, which is followed within some seconds, as an LEA-6 glides to another place
// (tools/validate, trees); a farther one at once.
constexpr double jump_deviations = 6;
constexpr double jump_floor_m = 5;
constexpr double glide_s = 2, farthest_glide_m = 1000;
// Epochs farther apart than this do not share a path.
constexpr double longest_gap_s = 10;

// Weights of the integral over the last interval of the polynomial through the last n velocities, the newest first
// (Adams and Moulton).
constexpr std::array<std::array<double, 4>, 3> path_weights{{
    {1.0 / 2, 1.0 / 2, 0, 0},
    {5.0 / 12, 8.0 / 12, -1.0 / 12, 0},
    {9.0 / 24, 19.0 / 24, -5.0 / 24, 1.0 / 24},
}};
// Root of the sum of squares of the difference between two rows: what white noise puts into it.
constexpr double path_noise = 0.2;

// How much longer or shorter single positions are remembered, by what the vehicle may do; ours.
double memory_factor(DynamicModel model) {
    switch (model) {
        case DynamicModel::stationary:
            return 4;
        case DynamicModel::airborne_1g:
            return 0.5;
        case DynamicModel::airborne_2g:
            return 0.4;
        case DynamicModel::airborne_4g:
            return 0.25;
        default:
            return 1;
    }
}

}  // namespace

Velocity<Ecef> VelocityFilter::update(const FilterParameters& parameters, GpsTime time, const Velocity<Ecef>& measured,
                                      MetresPerSecond deviation, DynamicModel model) {
    const double dt = time_ ? difference(time, *time_).value() : 0;
    time_ = time;
    const Vector3d before = measured_;
    measured_ = measured.vector();
    rests_ = false;
    if (!(dt > 0) || dt > longest_gap_s) {
        velocity_ = measured_;
        return measured;
    }
    const double noise = quiet_deviations * deviation.value();
    rests_ = (measured_ - velocity_).norm() < noise && velocity_.norm() < noise;
    const Seconds memory =
        (rests_ ? parameters.velocity_rest_memory : parameters.velocity_memory) * memory_factor(model);
    if (!(memory > Seconds(0))) {
        velocity_ = measured_;
        return measured;
    }
    const double tau = memory.value(), forgotten = -std::expm1(-dt / tau);
    if (rests_)
        velocity_ += forgotten * (measured_ - velocity_);
    else  // the answer to a straight line between the two epochs: late by the memory at every rate
        velocity_ += forgotten * (before - velocity_) + (1 - forgotten * tau / dt) * (measured_ - before);
    return Velocity<Ecef>(velocity_);
}

void PositionFilter::reset() { *this = PositionFilter(parameters_); }

void PositionFilter::start(const PositionInput& input) {
    position_ = input.position.vector();
    averaged_ = 1;
    settled_ = false;
    velocity_count_ = 0;
    lag_.setZero();
    late_.setZero();
}

// The way since the last epoch, and how unsure it is by what the next lower order says of it.
Vector3d PositionFilter::way(double dt, const PositionInput& input, double& unsure) const {
    const bool even = std::abs(dt - spacing_) < 1e-3 * dt;
    const int known = std::min(even ? velocity_count_ : std::min(velocity_count_, 1), 3);
    const auto integral = [&](int order) {
        const auto& weights = path_weights[static_cast<std::size_t>(order - 1)];
        Vector3d sum = weights[0] * input.velocity->vector();
        for (std::size_t i = 0; i < static_cast<std::size_t>(order); ++i)
            sum += weights[i + 1] * velocities_[i];
        return Vector3d(dt * sum);
    };
    const Vector3d best = integral(known);
    // Without a history nothing is known of manoeuvres; the filter is young then and follows anyway.
    const double spread = known >= 2 ? (best - integral(known - 1)).norm() : 0;
    unsure = std::max(0.0, spread - quiet_deviations * path_noise * dt * input.velocity_deviation.value());
    return best;
}

double PositionFilter::gain(double dt, double unsure, const ReceiverSettings& settings) {
    const double memory = parameters_.position_memory.value() * memory_factor(settings.dynamic_model);
    const double steady = memory > 0 ? 1 - std::exp(-dt / memory) : 1;
    const double young = 1 / (averaged_ + 1);
    settled_ = young <= 2 * steady;
    return std::max({steady, young, unsure / (unsure + tolerated_lag_m)});
}

void PositionFilter::remember(const PositionInput& input, double dt) {
    if (!input.velocity) {
        velocity_count_ = 0;
        return;
    }
    const bool even = std::abs(dt - spacing_) < 1e-3 * dt;
    if (!even) velocity_count_ = std::min(velocity_count_, 1);
    spacing_ = dt;
    for (std::size_t i = velocities_.size() - 1; i > 0; --i)
        velocities_[i] = velocities_[i - 1];
    velocities_[0] = input.velocity->vector();
    velocity_count_ = std::min(velocity_count_ + 1, 4);
}

bool PositionFilter::holds(const PositionInput& input, const Vector3d& velocity, const ReceiverSettings& settings) {
    const MetresPerSecond below = std::max(settings.static_hold_below, parameters_.hold_below);
    const bool slow = input.velocity && velocity.norm() < below.value();
    if (!slow) {
        held_.reset();
        return false;
    }
    const Vector3d position = position_ - lag_;
    if (held_ && (position - *held_).norm() > parameters_.static_hold_radius.value()) held_.reset();
    // What is held is an average, not the first position that came along.
    if (!held_ && settled_) held_ = position;
    return held_.has_value();
}

// What the reported velocity leaves out in a manoeuvre is missing in the reported position for a while.
void PositionFilter::lag(const Vector3d& late, double dt) {
    constexpr double caught_up_s = 3;  // ours
    lag_ = std::exp(-dt / caught_up_s) * (lag_ + dt / 2 * (late + late_));
    late_ = late;
}

FilteredPosition PositionFilter::update(const PositionInput& measured, const ReceiverSettings& settings) {
    PositionInput input = measured;
    std::optional<Vector3d> velocity;
    if (measured.velocity) {
        const Velocity<Ecef> filtered = velocity_filter_.update(parameters_, measured.time, *measured.velocity,
                                                                measured.velocity_deviation, settings.dynamic_model);
        velocity = filtered.vector();
        if (velocity_filter_.rests()) input.velocity = filtered;
    } else {
        velocity_filter_.reset();
    }
    const double dt = time_ ? difference(input.time, *time_).value() : 0;
    const bool follows =
        time_ && !interrupted_ && dt > 0 && dt < longest_gap_s && input.velocity && velocity_count_ > 0;
    if (follows) {
        double unsure = 0;
        const Vector3d predicted = position_ + way(dt, input, unsure);
        const Vector3d innovation = input.position.vector() - predicted;
        const bool jumps = innovation.norm() > jump_floor_m + jump_deviations * input.deviation.value();
        if (jumps && innovation.norm() > farthest_glide_m) {
            start(input);
        } else {
            const double caught_up = jumps ? -std::expm1(-dt / glide_s) : 0;
            const double share = std::max(gain(dt, unsure, settings), caught_up);
            position_ = predicted + share * innovation;
            averaged_ = 1 / share;
            lag(input.velocity->vector() - *velocity, dt);
        }
    } else {
        start(input);
    }
    if (dt != 0 || !time_) remember(input, dt);
    time_ = input.time;
    interrupted_ = false;
    reported_velocity_ = velocity.value_or(Vector3d::Zero());
    return reported(holds(input, reported_velocity_, settings));
}

FilteredPosition PositionFilter::reported(bool held) const {
    FilteredPosition filtered;
    filtered.held = held;
    filtered.position = Position<Ecef>(held ? *held_ : position_ - lag_);
    if (!held) filtered.velocity = Velocity<Ecef>(reported_velocity_);
    return filtered;
}

std::optional<FilteredPosition> PositionFilter::coast(GpsTime time) {
    if (!time_) return std::nullopt;
    const Seconds gone = difference(time, *time_);
    interrupted_ = true;
    if (gone > parameters_.coasting) {
        held_.reset();
        return std::nullopt;
    }
    const Vector3d velocity = velocity_count_ > 0 && !held_ ? reported_velocity_ : Vector3d::Zero();
    FilteredPosition carried = reported(held_.has_value());
    carried.position = Position<Ecef>(Vector3d(carried.position.vector() + gone.value() * velocity));
    carried.velocity = Velocity<Ecef>(velocity);
    carried.coasted = gone;
    return carried;
}

}  // namespace skyloop::inline receiver
