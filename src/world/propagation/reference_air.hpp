/// The mean annual global reference atmosphere.
/// How much slower than in the vacuum radio waves run in air.
#pragma once

#include "base/core/units.hpp"

namespace skyloop::inline world {

/// Air at one height.
struct ReferenceAir {
    Kelvin temperature;
    double pressure_hpa = 0;         ///< total
    double vapour_density_g_m3 = 0;  ///< of water
    /// Partial pressure of the vapour, e = ρ T/216.7, hPa (ITU-R P.835, equation 8).
    [[nodiscard]] double vapour_pressure_hpa() const { return vapour_density_g_m3 * temperature.value() / 216.7; }
    [[nodiscard]] double dry_pressure_hpa() const { return pressure_hpa - vapour_pressure_hpa(); }
};

/// Temperature and pressure of ITU-R P.835-6, section 1.1, with vapour that thins to 1/e over 2 km (section 1.2) from
/// 7.5 g/m³ at sea level (MODELS.md A.4).
/// @param height geometric, above sea level; what lies outside 0 … 100 km is taken at the nearer end
ReferenceAir reference_atmosphere_p835(Metres height, double sea_level_vapour_g_m3 = 7.5);

/// The same air with at least the vapour of the high atmosphere, a mixing ratio of 2e-6 in pressure (section 1.2).
ReferenceAir with_least_vapour(ReferenceAir air);

/// N = (n − 1)·1e6.
struct Refractivity {
    double dry = 0;
    double wet = 0;
    [[nodiscard]] double total() const { return dry + wet; }
};

/// N = 77.6 P_d/T + 72 e/T + 3.75e5 e/T² (ITU-R P.453-14, equations 3 to 5).
/// @param dry_pressure_hpa of the air without its vapour, hPa  @param vapour_pressure_hpa hPa
Refractivity refractivity_p453(double dry_pressure_hpa, Kelvin temperature, double vapour_pressure_hpa);

}  // namespace skyloop::inline world
