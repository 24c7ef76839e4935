/// Delays of the ionosphere: what the model says of all satellites, beside what was measured of some.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "receiver/pvt/single_point.hpp"

namespace skyloop::inline receiver {

/// The delay of one satellite, at its carrier.
struct WeighedDelay {
    double delay = 0;          ///< m; in: by the model, out: to be taken off
    double code_variance = 0;  ///< m², of the echoes in one code
    std::optional<MeasuredDelay> measured;
    double variance = 0;    ///< m², out: of what was measured, as far as it was taken
    std::size_t index = 0;  ///< the caller's
};

/// What is measured says first by how much the model is wrong for all satellites today, and then of each by itself.
/// @return how wrong the model's shape may still be, as a share of how wrong it was
double weigh_measured_delays(std::span<WeighedDelay> delays);

}  // namespace skyloop::inline receiver
