#include "world/propagation/cloud_attenuation_p840.hpp"

namespace skyloop {

std::complex<double> water_permittivity_p840(Hertz carrier, Kelvin temperature) {
    const double f = carrier.value() / 1e9;
    const double x = 300 / temperature.value() - 1;
    const double e0 = 77.66 + 103.3 * x;
    const double e1 = 0.0671 * e0;
    const double e2 = 3.52;
    const double principal = 20.20 - 146 * x + 316 * x * x;  // relaxation frequencies, GHz
    const double secondary = 39.8 * principal;
    const double u = f / principal, v = f / secondary;
    return {(e0 - e1) / (1 + u * u) + (e1 - e2) / (1 + v * v) + e2,
            u * (e0 - e1) / (1 + u * u) + v * (e1 - e2) / (1 + v * v)};
}

double cloud_liquid_coefficient_p840(Hertz carrier, Kelvin temperature) {
    const std::complex<double> water = water_permittivity_p840(carrier, temperature);
    const double eta = (2 + water.real()) / water.imag();
    return 0.819 * carrier.value() / 1e9 / (water.imag() * (1 + eta * eta));
}

DecibelsPerKilometre cloud_attenuation_p840(Hertz carrier, Kelvin temperature, double liquid_water_g_m3) {
    return DecibelsPerKilometre(cloud_liquid_coefficient_p840(carrier, temperature) * liquid_water_g_m3);
}

}  // namespace skyloop
