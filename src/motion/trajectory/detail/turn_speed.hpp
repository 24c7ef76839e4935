// Turns of planes, boats and cars at a speed.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "motion/trajectory/planar_curve.hpp"
#include "motion/trajectory/vehicle.hpp"

namespace skyloop {

// The turn that needs the lateral acceleration, or the smallest radius where that asks for less.
inline TurnShape turn_at_speed(const VehicleLimits& vehicle, double angle, double speed) {
    constexpr double least_ramp = 0.05;  // of the radius: nothing steers at once
    TurnShape turn;
    turn.angle = angle;
    turn.radius = std::max({speed * speed / vehicle.lateral, vehicle.radius, 1e-3});
    turn.ramp = std::max(speed * vehicle.turn_ramp, least_ramp * turn.radius);
    return turn;
}

inline constexpr double no_turn = 1e-9;  // rad

// How far before its corner a turn would like to begin, m.
inline double wanted_by_turn(const VehicleLimits& vehicle, double angle, double speed) {
    if (std::abs(angle) < no_turn) return 0;
    return std::min(vehicle.corner, tangent_length(turn_at_speed(vehicle, angle, speed)));
}

inline double slowest_turn(const VehicleLimits& vehicle) { return std::max(vehicle.slowest, 0.1); }

// The fastest turn at a corner that begins within `free` metres of it; nothing: none does.
inline std::optional<double> fastest_turn(const VehicleLimits& vehicle, double angle, double speed, double free) {
    const auto fits = [&](double v) { return tangent_length(turn_at_speed(vehicle, angle, v)) <= free; };
    if (fits(speed)) return speed;
    double low = std::min(slowest_turn(vehicle), speed), high = speed;
    if (!fits(low)) return std::nullopt;
    for (int i = 0; i < 40; ++i) {
        const double middle = (low + high) / 2;
        (fits(middle) ? low : high) = middle;
    }
    return low;
}

}  // namespace skyloop
