/// Gaussian noise that is a function of place: no stream, no state, the same in whatever order it is asked for.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>

namespace skyloop::inline world {

/// Spreads a number over 64 bits: the finaliser of SplitMix64 (Steele, Lea and Flood 2014).
constexpr std::uint64_t spread_bits(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

/// The key of a noise of its own. @param name what it is for
std::uint64_t noise_key(std::uint64_t seed, std::string_view name);

/// Standard normal but for its tails, which end at 3.5: the sum of four uniform numbers of 16 bits.
inline double normal_of_bits(std::uint64_t bits) {
    const auto sum = (bits & 0xffffu) + ((bits >> 16) & 0xffffu) + ((bits >> 32) & 0xffffu) + (bits >> 48);
    constexpr double unit = 65536 * 0.57735026918962576;  // √(4/12) of a uniform number's range
    return (static_cast<double>(sum) - 2 * 65535) / unit;
}

/// Uniform in [0, 1).
inline double uniform_of_bits(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

/// Of the noise below: distance in cells at which its correlation is 1/e, that from which it is nothing (below 2 %),
/// and −R''(0), by which it crosses a level (Rice 1945), per cell². The autocorrelation of a quadratic spline of white
/// noise is the quintic spline over its value at 0.
inline constexpr double noise_correlation_cells = 1.04;
inline constexpr double noise_reach_cells = 2;
inline constexpr double noise_curvature = 1 / 0.55;

/// Where a coordinate lies between the knots of a quadratic spline: three of them and their weights, of which the
/// squares add up to 1, so that the noise has the same variance everywhere.
struct NoiseKnots {
    explicit NoiseKnots(double cells) {
        const double nearest = std::floor(cells + 0.5), x = cells - nearest;
        const double before = (0.5 - x) * (0.5 - x) / 2, middle = 0.75 - x * x, after = (0.5 + x) * (0.5 + x) / 2;
        const double norm = 1 / std::sqrt(before * before + middle * middle + after * after);
        weights = {before * norm, middle * norm, after * norm};
        const auto first = static_cast<std::int64_t>(nearest) - 1;
        for (std::size_t i = 0; i < 3; ++i)
            hashes[i] = spread_bits(static_cast<std::uint64_t>(first) + i);
    }
    std::array<double, 3> weights{};
    std::array<std::uint64_t, 3> hashes{};  // of the three
};

/// The sum of a quadratic spline over N coordinates, from that of number `Next` on.
template <std::size_t N, std::size_t Next = 0>
double spline_noise(std::uint64_t key, const std::array<NoiseKnots, N>& knots) {
    if constexpr (Next == N) {
        return normal_of_bits(key);
    } else {
        double sum = 0;
        for (std::size_t i = 0; i < 3; ++i)
            sum += knots[Next].weights[i] * spline_noise<N, Next + 1>(spread_bits(key ^ knots[Next].hashes[i]), knots);
        return sum;
    }
}

/// Standard normal everywhere, and smooth: its slope is continuous. @param cells coordinates, in cells of the lattice
template <std::size_t N>
double smooth_noise(std::uint64_t key, const std::array<double, N>& cells) {
    std::array<NoiseKnots, N> knots = [&]<std::size_t... I>(std::index_sequence<I...>) {
        return std::array<NoiseKnots, N>{NoiseKnots(cells[I])...};
    }
    (std::make_index_sequence<N>());
    return spline_noise(key, knots);
}

/// Probability that a standard normal number is below x.
inline double normal_distribution(double x) { return 0.5 * std::erfc(-x * 0.70710678118654752); }
/// Its inverse, to 1e-9. @param p 0 … 1, exclusive
double normal_quantile(double p);

}  // namespace skyloop::inline world
