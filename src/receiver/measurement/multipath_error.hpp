/// Where a code loop settles when echoes reach it beside the direct signal.
#pragma once

#include <span>

#include "base/core/units.hpp"

namespace skyloop {

/// An echo, against the direct signal.
struct SignalEcho {
    double amplitude = 0;    ///< relative, not negative
    double delay_chips = 0;  ///< later than the direct signal; below 0: earlier, where that is blocked
    Angle phase;             ///< of its carrier against that of the direct signal
};

/// The error of the code phase, chips, positive when ranges come out too long: the root nearest to zero of the coherent
/// early-minus-late discriminator on an ideal triangle of correlation (MODELS.md 7.10).
/// @param spacing_chips d, early to late, above 0
double multipath_code_error_chips(std::span<const SignalEcho> echoes, double spacing_chips);

}  // namespace skyloop
