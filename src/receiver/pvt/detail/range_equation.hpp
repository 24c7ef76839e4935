/// What a receiver makes of the ranges of one satellite.
#pragma once

#include <optional>
#include <span>

#include "receiver/pvt/single_point.hpp"
#include "receiver/pvt/transmitter.hpp"
#include "world/flow/observations.hpp"

namespace skyloop {

/// The equation of a pseudorange, or of the combination of two that the ionosphere does not touch: of frequencies f₁
/// and f₂, (f₁² P₁ − f₂² P₂)/(f₁² − f₂²) (IS-GPS-200, 20.3.3.3.3.3 without its group delays, which the transmitters
/// know).
/// @param first with a pseudorange @param others of the same satellite, each with a pseudorange: the first of them on
/// another carrier whose group delay is known is combined with it  @return nothing where no orbit is known
std::optional<RangeEquation> range_equation(TransmitterSource& transmitters, const Observation& first,
                                            std::span<const Observation* const> others, GpsTime receive_time);

}  // namespace skyloop
