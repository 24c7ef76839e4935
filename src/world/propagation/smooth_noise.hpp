/// Gaussian noise that is a function of place: no stream, no state, the same in whatever order it is asked for.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
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

/// The sum of the four numbers of 16 bits that 64 bits are; its mean and standard deviation.
inline double quarters_of_bits(std::uint64_t bits) {
    constexpr std::uint64_t every_other = 0x0000ffff0000ffffu;
    const std::uint64_t pairs = (bits & every_other) + ((bits >> 16) & every_other);
    return static_cast<double>((pairs & 0xffffffffu) + (pairs >> 32));
}
inline constexpr double quarters_mean = 2 * 65535, quarters_deviation = 65536 * 0.57735026918962576;  // √(4/12)

/// Standard normal but for its tails, which end at 3.5.
inline double normal_of_bits(std::uint64_t bits) {
    return (quarters_of_bits(bits) - quarters_mean) / quarters_deviation;
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
    [[nodiscard]] double weight() const { return weights[0] + weights[1] + weights[2]; }
    std::array<double, 3> weights{};
    std::array<std::uint64_t, 3> hashes{};  // of the three
};

/// The sum of a quadratic spline over N coordinates, from that of number `Next` on; of quarters_of_bits(), which become
/// normal in the end.
template <std::size_t N, std::size_t Next = 0>
double spline_sum(std::uint64_t key, const std::array<NoiseKnots, N>& knots) {
    if constexpr (Next == N) {
        return quarters_of_bits(key);
    } else {
        double sum = 0;
        for (std::size_t i = 0; i < 3; ++i)
            sum += knots[Next].weights[i] * spline_sum<N, Next + 1>(spread_bits(key ^ knots[Next].hashes[i]), knots);
        return sum;
    }
}

/// The same as noise.
template <std::size_t N>
double spline_noise(std::uint64_t key, const std::array<NoiseKnots, N>& knots) {
    double weight = 1;
    for (const NoiseKnots& coordinate : knots)
        weight *= coordinate.weight();
    return (spline_sum(key, knots) - quarters_mean * weight) / quarters_deviation;
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

/// smooth_noise() of three coordinates where one place is asked for after another near to it: the numbers at the knots
/// around the last one are remembered. What it returns depends on key and place alone.
///
/// State: those numbers.
class NearbyNoise {
public:
    double at(std::uint64_t key, const std::array<double, 3>& cells) {
        std::array<std::int64_t, 3> nearest;
        std::array<std::array<double, 3>, 3> weights;
        double square = 1;
        for (std::size_t i = 0; i < 3; ++i) {
            const double shifted = cells[i] + 0.5;
            nearest[i] = static_cast<std::int64_t>(shifted);
            nearest[i] -= static_cast<double>(nearest[i]) > shifted ? 1 : 0;  // rounded down, without std::floor's call
            const double x = cells[i] - static_cast<double>(nearest[i]);
            weights[i] = {(0.5 - x) * (0.5 - x) / 2, 0.75 - x * x, (0.5 + x) * (0.5 + x) / 2};
            square *= 0.59375 + x * x * (1.5 * x * x - 0.75);  // the sum of the weights' squares
        }
        if (nearest != nearest_ || key != key_) remember(key, nearest);
        return sum(weights) / std::sqrt(square);
    }

private:
    void remember(std::uint64_t key, const std::array<std::int64_t, 3>& nearest);
    [[nodiscard]] double sum(const std::array<std::array<double, 3>, 3>& weights) const {
        double all = 0;
        for (std::size_t x = 0; x < 3; ++x) {
            double plane = 0;
            for (std::size_t y = 0; y < 3; ++y) {
                const double* line = &numbers_[9 * x + 3 * y];
                plane += weights[1][y] * (weights[2][0] * line[0] + weights[2][1] * line[1] + weights[2][2] * line[2]);
            }
            all += weights[0][x] * plane;
        }
        return all;
    }

    std::uint64_t key_ = 0;
    std::array<std::int64_t, 3> nearest_{std::numeric_limits<std::int64_t>::min()};  // no place has it
    std::array<double, 27> numbers_{};
};

/// Probability that a standard normal number is below x.
inline double normal_distribution(double x) { return 0.5 * std::erfc(-x * 0.70710678118654752); }
/// Its inverse, to 1e-9. @param p 0 … 1, exclusive
double normal_quantile(double p);

}  // namespace skyloop::inline world
