/// What oxygen and water vapour absorb, line by line.
#pragma once

#include <span>
#include <vector>

#include "world/propagation/reference_atmosphere_p835.hpp"
#include "world/propagation/specific_attenuation.hpp"

namespace skyloop {

/// Specific attenuation of the two gases; oxygen includes the dry continuum.
struct GasAttenuation {
    DecibelsPerKilometre oxygen;
    DecibelsPerKilometre vapour;
    [[nodiscard]] DecibelsPerKilometre total() const { return oxygen + vapour; }
};

/// ITU-R P.676-13, Annex 1, equations 1 to 9 and tables 1 and 2. For 1 … 1000 GHz.
GasAttenuation gas_attenuation_p676(const ReferenceAir& air, Hertz carrier);

/// Along the bent ray from an antenna through the reference atmosphere to 100 km: layers that grow by 1 %, Snell's law
/// between them (ITU-R P.676-13, Annex 1, section 2.2; refractivity of P.453).
/// @param apparent elevation at the antenna, above the horizon
/// @param antenna_height above sea level
Decibels slant_gas_attenuation_p676(Hertz carrier, Angle apparent, Metres antenna_height);
/// The same along several rays from one antenna, for little more than the price of one.
std::vector<Decibels> slant_gas_attenuation_p676(Hertz carrier, std::span<const Angle> apparent, Metres antenna_height);

}  // namespace skyloop
