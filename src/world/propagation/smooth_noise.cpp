#include "world/propagation/smooth_noise.hpp"

#include "base/core/bytes.hpp"

namespace skyloop::inline world {

std::uint64_t noise_key(std::uint64_t seed, std::string_view name) { return spread_bits(seed) ^ fnv1a_64(name); }

void NearbyNoise::remember(std::uint64_t key, const std::array<std::int64_t, 3>& nearest) {
    std::array<std::array<std::uint64_t, 3>, 3> hashes;
    for (std::size_t i = 0; i < 9; ++i)
        hashes[i / 3][i % 3] = spread_bits(static_cast<std::uint64_t>(nearest[i / 3] - 1) + i % 3);
    std::size_t at = 0;
    for (const std::uint64_t x : hashes[0]) {
        const std::uint64_t plane = spread_bits(key ^ x);
        for (const std::uint64_t y : hashes[1]) {
            const std::uint64_t line = spread_bits(plane ^ y);
            for (const std::uint64_t z : hashes[2])
                numbers_[at++] = normal_of_bits(spread_bits(line ^ z));
        }
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
