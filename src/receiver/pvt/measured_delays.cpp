#include <algorithm>
#include <cmath>

#include "detail/measured_delays.hpp"

namespace skyloop::inline receiver {
namespace {

// Of a satellite's delay, 1 σ: what a model that is broadcast for the whole Earth leaves (IS-GPS-200, 20.3.3.5.2.5:
// half of the rms), and what is left where the day's measure of it is known; the latter are ours.
constexpr double model_share = 0.5, scaled_share = 0.15, scaled_floor_m = 0.3;

double squared(double x) { return x * x; }

double own_variance(double delay) { return squared(scaled_share * delay) + squared(scaled_floor_m); }

}  // namespace

double weigh_measured_delays(std::span<WeighedDelay> delays) {
    double information = 1 / squared(model_share), sum = information;
    for (const WeighedDelay& d : delays) {
        if (!d.measured) continue;
        const double variance = d.measured->variance_factor * d.code_variance + own_variance(d.delay);
        information += d.delay * d.delay / variance;
        sum += d.delay * d.measured->delay.value() / variance;
    }
    const double scale = std::max(sum / information, 0.0);
    for (WeighedDelay& d : delays) {
        d.delay *= scale;
        if (!d.measured) continue;
        const double variance = d.measured->variance_factor * d.code_variance;
        const double share = own_variance(d.delay) / (own_variance(d.delay) + variance);
        d.delay += share * (d.measured->delay.value() - d.delay);
        d.variance = share * share * variance;
    }
    return std::sqrt(1 / information) / model_share;
}

}  // namespace skyloop::inline receiver
