/// The count of a carrier's cycles: what it starts from and how it breaks.
#pragma once

#include "base/core/random.hpp"
#include "base/core/units.hpp"
#include "receiver/measurement/measurement_parameters.hpp"

namespace skyloop {

/// How often a carrier loop slips by itself, 1/s: 2 B erfc(π/(2√2 σ)), the probability that a Gaussian phase error σ
/// lies beyond the ±90° of a Costas loop, once for each independent error. Nothing below 0.2 rad (10⁻¹² per hour).
/// @param jitter σ of the phase, 1 σ
double slips_per_second(const CarrierLoop& loop, Angle jitter);

/// The whole and half cycles between phase and range.
///
/// State: the count, and the random numbers of its starts and of its slips.
class CycleCount {
public:
    CycleCount(RandomStream starts, RandomStream slips) : starts_(starts), slips_(slips) {}

    /// A new lock, at a whole number of cycles. @param half_unknown a half cycle may be among them
    void start(bool half_unknown);
    /// Lets a slip happen or not: one or two cycles, or halves of them while the half cycle is not resolved.
    /// @param expected number of slips in the time that passed
    bool slip(double expected, bool half_cycle_resolved);
    /// Takes a half cycle out when the data bits have shown it. Tells whether there was one.
    bool resolve_half_cycle();
    [[nodiscard]] double cycles() const { return cycles_; }

private:
    RandomStream starts_, slips_;
    double cycles_ = 0;
};

}  // namespace skyloop
