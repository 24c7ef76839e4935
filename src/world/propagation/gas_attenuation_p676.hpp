/// What oxygen and water vapour absorb, line by line.
/// The absorption lines of oxygen and water vapour (ITU-R P.676-13, Annex 1, tables 1 and 2).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "world/propagation/reference_air.hpp"
#include "world/propagation/specific_attenuation.hpp"

namespace skyloop::inline world {

/// A line at f0 GHz with the parameters a1 … a6 of table 1.
struct OxygenLine {
    double f0, a1, a2, a3, a4, a5, a6;
};
/// A line at f0 GHz with the parameters b1 … b6 of table 2.
struct VapourLine {
    double f0, b1, b2, b3, b4, b5, b6;
};

extern const std::array<OxygenLine, 44> oxygen_lines_p676;
extern const std::array<VapourLine, 35> vapour_lines_p676;

/// Specific attenuation of the two gases; oxygen includes the dry continuum.
struct GasAttenuation {
    DecibelsPerKilometre oxygen;
    DecibelsPerKilometre vapour;
    [[nodiscard]] DecibelsPerKilometre total() const { return oxygen + vapour; }
};

/// ITU-R P.676-13, Annex 1, equations 1 to 9 and tables 1 and 2. For 1 … 1000 GHz.
GasAttenuation gas_attenuation_p676(const ReferenceAir& air, Hertz carrier);

/// Along the bent ray from an antenna through the reference atmosphere to 100 km: layers that grow by 1 %, Snell's law
/// between them (ITU-R P.676-13, Annex 1, section 2.2; refractivity of P.453). Several rays from one antenna cost
/// little more than one.
/// @param apparent elevations at the antenna, above the horizon
/// @param antenna_height above sea level
/// @returns one for each elevation
std::vector<Decibels> slant_gas_attenuation_p676(Hertz carrier, std::span<const Angle> apparent, Metres antenna_height);

}  // namespace skyloop::inline world
