/// Random numbers from named streams: adding a stream never changes the numbers of another.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace skyloop {

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

}  // namespace skyloop
