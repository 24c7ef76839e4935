/// Angles that grow at a constant rate over decades.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace skyloop::inline world {

/// start + rate·count reduced to ±π. The product is kept whole by its rounding error, so that neighbouring counts
/// differ by exactly one step even after decades.
inline double reduced_angle(double start, double rate, std::int64_t count) {
    const auto times = static_cast<double>(count);
    const double product = rate * times;
    const double rounding = std::fma(rate, times, -product);
    constexpr double turn = 2 * std::numbers::pi;
    return std::remainder(std::remainder(product, turn) + rounding + start, turn);
}

/// Rounded down.
inline std::int64_t floor_divide(std::int64_t a, std::int64_t b) { return a / b - (a % b < 0 ? 1 : 0); }

}  // namespace skyloop::inline world
