#include "world/propagation/smooth_noise.hpp"

#include "base/core/bytes.hpp"

namespace skyloop::inline world {

std::uint64_t noise_key(std::uint64_t seed, std::string_view name) { return spread_bits(seed) ^ fnv1a_64(name); }

void NearbyNoise::remember(std::uint64_t key, const std::array<std::int64_t, 3>& nearest) {
    const auto hash = [&](std::size_t coordinate, std::uint64_t knot) {
        return spread_bits(static_cast<std::uint64_t>(nearest[coordinate] - 1) + knot);
    };
    for (std::size_t i = 0; i < numbers_.size(); ++i) {
        const std::uint64_t plane = spread_bits(key ^ hash(0, i / 9)), line = spread_bits(plane ^ hash(1, i / 3 % 3));
        numbers_[i] = normal_of_bits(spread_bits(line ^ hash(2, i % 3)));
    }
    key_ = key;
    nearest_ = nearest;
}

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
