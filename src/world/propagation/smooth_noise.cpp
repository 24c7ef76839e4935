#include "world/propagation/smooth_noise.hpp"

#include "base/core/bytes.hpp"

namespace skyloop::inline world {

std::uint64_t noise_key(std::uint64_t seed, std::string_view name) { return spread_bits(seed) ^ fnv1a_64(name); }

double normal_quantile(double p) {
    // Newton's steps from a start that the logistic distribution gives; the tails need the most of them.
    double x = std::log(p / (1 - p)) / 1.702;
    for (int i = 0; i < 60; ++i) {
        const double density = std::exp(-x * x / 2) * 0.39894228040143268;
        const double step = (normal_distribution(x) - p) / density;
        x -= std::fmin(std::fmax(step, -0.5), 0.5);
        if (std::abs(step) < 1e-10) break;
    }
    return x;
}

}  // namespace skyloop::inline world
