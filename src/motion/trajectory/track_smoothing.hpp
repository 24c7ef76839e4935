/// Noise of recorded positions, and its removal.
#pragma once

#include <cstddef>
#include <optional>

#include "base/core/units.hpp"
#include "motion/trajectory/track.hpp"
#include "motion/trajectory/vehicle_class.hpp"

namespace skyloop {

/// Whether the rows of a track are smoothed before the curve is led through them.
enum class Smoothing {
    none,    ///< the curve goes through the rows
    noise,   ///< by the noise that the rows show, where it is more than the vehicle's motion could be
    sensor,  ///< as positions of a satellite receiver: 1.5 m in plan, 3 m up
};

/// Standard deviations, m.
struct PositionNoise {
    double in_plan = 0, up = 0;
};

/// The noise of the rows, by the median of their fourth differences, less what a vehicle's white jerk makes of them: of
/// steps h, 2/3 q h⁵ (the integral of the third difference's quadratic B-spline), where white noise σ makes 70 σ². Zero
/// where the motion alone explains them. Rows that are not evenly spaced are left out.
PositionNoise noise_of(const Track& track, VehicleClass vehicle);

/// What smoothing did.
struct SmoothingReport {
    std::optional<PositionNoise> taken{};  ///< nothing: the rows were kept
    std::size_t outliers = 0;              ///< rows further than 5 σ from where the motion led, which did not count
    double largest_shift = 0;              ///< of a row that counts, m
};

/// Moves the rows onto the path that a Rauch–Tung–Striebel smoother gives (FEEDS.md 1.13.2, step 3): white jerk of the
/// vehicle's density on each axis, positions with this noise, velocities, where they are told, with 0.3 m/s. All rows
/// get a velocity. Works from jump to jump.
SmoothingReport smooth_track(Track& track, VehicleClass vehicle, Smoothing smoothing);

}  // namespace skyloop
