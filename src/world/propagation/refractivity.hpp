/// How much slower than in the vacuum radio waves run in air.
#pragma once

#include "base/core/units.hpp"

namespace skyloop {

/// N = (n − 1)·1e6.
struct Refractivity {
    double dry = 0;
    double wet = 0;
    [[nodiscard]] double total() const { return dry + wet; }
};

/// N = 77.6 P_d/T + 72 e/T + 3.75e5 e/T² (ITU-R P.453-14, equations 3 to 5).
/// @param dry_pressure_hpa of the air without its vapour, hPa  @param vapour_pressure_hpa hPa
Refractivity refractivity_p453(double dry_pressure_hpa, Kelvin temperature, double vapour_pressure_hpa);

}  // namespace skyloop
