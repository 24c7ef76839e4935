/// What every cause of an error can be told by itself: off, weaker or stronger, with dice of its own.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "base/core/random.hpp"

namespace skyloop {

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

}  // namespace skyloop
