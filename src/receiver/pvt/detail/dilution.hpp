/// Dilutions of precision of a solution.
#pragma once

#include <optional>
#include <span>

#include "receiver/pvt/single_point.hpp"

namespace skyloop::inline receiver {

/// The geometry of the used ranges with unit weights. TDOP and GDOP take the reference clock; with a held height GDOP,
/// PDOP and VDOP are not numbers.
/// @param equations in the order of solution.ranges  @return nothing for a singular geometry
std::optional<Dop> dilution_of(std::span<const RangeEquation> equations, const SinglePoint& solution);

}  // namespace skyloop::inline receiver
