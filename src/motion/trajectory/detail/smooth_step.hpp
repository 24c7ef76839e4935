// From one value to another without a step of the second derivative.
#pragma once

#include <algorithm>

namespace skyloop::inline motion {

struct SmoothStep {
    double value = 0, slope = 0, bend = 0;  // and its first and second derivative
};

// u³ (10 − 15 u + 6 u²) between 0 and 1 (FEEDS.md 2.5).
inline SmoothStep smooth_step(double u) {
    u = std::clamp(u, 0.0, 1.0);
    return {u * u * u * (10 + u * (-15 + 6 * u)), 30 * u * u * (1 - u) * (1 - u), 60 * u * (1 - u) * (1 - 2 * u)};
}
constexpr double steepest_of_smooth_step = 1.875;   // its largest slope, in the middle
constexpr double sharpest_of_smooth_step = 5.7736;  // its largest second derivative, 10 / √3

}  // namespace skyloop::inline motion
