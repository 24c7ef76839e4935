/// What the droplets of fog and clouds absorb.
#pragma once

#include <complex>

#include "world/propagation/specific_attenuation.hpp"

namespace skyloop {

/// ε′ + jε″ of liquid water by two Debye relaxations (ITU-R P.840-8, equations 4 to 11).
std::complex<double> water_permittivity_p840(Hertz carrier, Kelvin temperature);

/// K_l of liquid water droplets, (dB/km)/(g/m³), by Rayleigh scattering (ITU-R P.840-8, equations 2 and 3). Up to 200
/// GHz.
double cloud_liquid_coefficient_p840(Hertz carrier, Kelvin temperature);

/// K_l times the content of liquid water.
DecibelsPerKilometre cloud_attenuation_p840(Hertz carrier, Kelvin temperature, double liquid_water_g_m3);

}  // namespace skyloop
