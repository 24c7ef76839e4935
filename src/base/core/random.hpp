/// Random numbers from named streams: adding a stream never changes the numbers of another.
/// First-order Gauss-Markov processes: errors that forget themselves with time.
/// What every cause of an error can be told by itself: off, weaker or stronger, with dice of its own.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "base/core/units.hpp"

namespace skyloop::inline base {

/// A seeded stream of random numbers. bits() and uniform() are the same on every platform and build; normal() is as
/// far as the C library's log() is, which may differ in its last bit.
///
/// State: xoshiro256++ (Blackman and Vigna, 2019), seeded by SplitMix64 from the run's seed and the stream's name.
class RandomStream {
public:
    /// @param seed the run's seed
    /// @param name what the numbers are for, e.g. "baseline.position"; different names are independent
    RandomStream(std::uint64_t seed, std::string_view name);

    /// Uniform over all 64-bit values.
    std::uint64_t bits();
    /// Uniform in [0, 1), 53 bits.
    double uniform();
    /// Standard normal, by the polar method (Marsaglia and Bray, 1964).
    double normal();

private:
    std::array<std::uint64_t, 4> state_{};
    std::optional<double> spare_normal_;
};

/// Standard normal numbers by index: the order in which they are asked for does not matter.
class IndexedNormals {
public:
    /// @param stream gives its first number as the key
    explicit IndexedNormals(RandomStream stream) : key_(stream.bits()) {}
    /// By Box and Muller (1958), from SplitMix64.
    [[nodiscard]] double at(std::int64_t index) const;

private:
    std::uint64_t key_;
};

/// The two numbers that say all of a first-order Gauss-Markov process.
struct GaussMarkovParameters {
    double sigma = 0;          ///< stationary standard deviation, in the unit of the process
    Seconds correlation_time;  ///< over which the autocorrelation falls to 1/e; 0: white
};

/// x[k+1] = φ x[k] + w with w ~ N(0, noise²).
struct GaussMarkovStep {
    double phi = 0;
    double noise = 0;  ///< standard deviation of w
};

/// The discrete form over a step of time: φ = exp(−Δt/τ), noise = σ √(1 − φ²) (MODELS.md 7.15; Brown and Hwang).
/// @param dt not negative
GaussMarkovStep gauss_markov_step(const GaussMarkovParameters& parameters, Seconds dt);

/// A seeded process that starts in its stationary distribution.
///
/// State: the present value and its own stream of random numbers.
class GaussMarkov {
public:
    /// @param stream of this process alone, named for what it drives
    GaussMarkov(GaussMarkovParameters parameters, RandomStream stream);
    [[nodiscard]] double value() const { return value_; }
    /// Lets `dt` pass and returns the new value. No time, no change and no random number taken.
    double advance(Seconds dt);

private:
    GaussMarkovParameters parameters_;
    RandomStream stream_;
    double value_;
};

/// The switch, the scale and the seed of one cause.
struct ErrorTerm {
    bool enabled = true;
    double scale = 1;                   ///< of the delay, loss or error that the cause makes
    std::optional<std::uint64_t> seed;  ///< nothing: the run's

    /// What its magnitudes are multiplied by: 0 when it is switched off.
    [[nodiscard]] double factor() const { return enabled ? scale : 0; }
    /// A stream of random numbers of this cause. @param name what the numbers are for
    [[nodiscard]] RandomStream stream(std::uint64_t run_seed, std::string_view name) const {
        return {seed.value_or(run_seed), name};
    }
};

}  // namespace skyloop::inline base
