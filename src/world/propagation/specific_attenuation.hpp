/// What a kilometre of air, vapour or rain takes from a signal.
/// What the droplets of fog and clouds absorb.
#pragma once

#include <complex>

#include "base/core/units.hpp"
#include "world/propagation/propagation_parameters.hpp"

namespace skyloop::inline world {

/// Attenuation per length, dB/km: the unit in which all its sources give it.
using DecibelsPerKilometre = Quantity<struct DecibelsPerKilometreUnit>;

/// Loss over a path of uniform attenuation.
inline Decibels loss_over(DecibelsPerKilometre attenuation, Metres path) {
    return Decibels(attenuation.value() * path.value() / 1000);
}

/// Height over which the air thins to 1/e, H = R_gas T/(g m_air) (MODELS.md 3.6; 8434.7 m at 288.15 K).
Metres scale_height(const AtmosphereParameters& atmosphere);

/// Equivalent concentration k = exp(−h/H) of the air at a height.
double concentration_at(Metres height, const AtmosphereParameters& atmosphere);
/// Equivalent concentration of a layer, by the layer's own mode: mean of k over it, k in its middle, or a given number.
double layer_concentration(const AtmosphericLayer& layer, const AtmosphereParameters& atmosphere);

/// Oxygen, by the article's rational formula (MODELS.md 3.6, A_o2; CCIR Report 719). Below 57 GHz.
/// @param concentration k  @param constant 0.277 GHz² as printed, 0.227 in the primary source
DecibelsPerKilometre oxygen_attenuation(Hertz carrier, double concentration, double constant);

/// Water vapour, by the article's rational formula (MODELS.md 3.6, A_vap).
/// @param density_g_m3 before it is multiplied by the concentration k
DecibelsPerKilometre vapour_attenuation(Hertz carrier, double density_g_m3, double concentration);

/// k and α of the power law γ_R = k R^α, dB/km with R in mm/h.
struct RainCoefficients {
    double k = 0;
    double alpha = 0;
};

/// ITU-R P.838-3, equations 2 to 5 and tables 1 to 4. For 1 … 1000 GHz.
/// @param tilt of the polarisation against the horizontal, 45° for circular polarisation
RainCoefficients rain_coefficients(Hertz carrier, Angle elevation, Angle tilt = Angle::degrees(45));

/// Rain, by the model that `rain` names (MODELS.md 3.6 and D-14).
DecibelsPerKilometre rain_attenuation(const Rain& rain, Hertz carrier, Angle elevation);

/// ε′ + jε″ of liquid water by two Debye relaxations (ITU-R P.840-8, equations 4 to 11).
std::complex<double> water_permittivity_p840(Hertz carrier, Kelvin temperature);

/// K_l of liquid water droplets, (dB/km)/(g/m³), by Rayleigh scattering (ITU-R P.840-8, equations 2 and 3). Up to 200
/// GHz.
double cloud_liquid_coefficient_p840(Hertz carrier, Kelvin temperature);

/// K_l times the content of liquid water.
DecibelsPerKilometre cloud_attenuation_p840(Hertz carrier, Kelvin temperature, double liquid_water_g_m3);

}  // namespace skyloop::inline world
