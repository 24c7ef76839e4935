#include "world/propagation/reference_air.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace skyloop::inline world {
namespace {

// A layer of constant temperature gradient, by geopotential height.
struct P835Layer {
    double base_km;
    double temperature;   // at the base, K
    double gradient;      // K/km
    double pressure_hpa;  // at the base
};
constexpr std::array<P835Layer, 7> p835_layers{{{0, 288.15, -6.5, 1013.25},
                                                {11, 216.65, 0, 226.3226},
                                                {20, 216.65, 1, 54.74980},
                                                {32, 228.65, 2.8, 8.680422},
                                                {47, 270.65, 0, 1.109106},
                                                {51, 270.65, -2.8, 0.6694167},
                                                {71, 214.65, -2, 0.03956649}}};
constexpr double hydrostatic_constant = 34.1632;  // g m/R, K/km

ReferenceAir geopotential_regime(double height_km) {
    const double h = 6356.766 * height_km / (6356.766 + height_km);
    const auto next = std::find_if(p835_layers.begin() + 1, p835_layers.end(),
                                   [&](const P835Layer& layer) { return layer.base_km > h; });
    const P835Layer& layer = *(next - 1);
    const double temperature = layer.temperature + layer.gradient * (h - layer.base_km);
    const double thinning = layer.gradient == 0
                                ? std::exp(-hydrostatic_constant * (h - layer.base_km) / layer.temperature)
                                : std::pow(layer.temperature / temperature, hydrostatic_constant / layer.gradient);
    return {Kelvin(temperature), layer.pressure_hpa * thinning, 0};
}

// Above 86 km, by geometric height.
ReferenceAir geometric_regime(double h) {
    const double ellipse = (std::max(h, 91.0) - 91) / 19.9429;
    const double temperature = h < 91 ? 186.8673 : 263.1905 - 76.3232 * std::sqrt(1 - ellipse * ellipse);
    const double exponent = 95.571899 + h * (-4.011801 + h * (6.424731e-2 + h * (-4.789660e-4 + h * 1.340543e-6)));
    return {Kelvin(temperature), std::exp(exponent), 0};
}

}  // namespace

ReferenceAir reference_atmosphere_p835(Metres height, double sea_level_vapour_g_m3) {
    const double h = std::clamp(height.value() / 1000, 0.0, 100.0);
    ReferenceAir air = h < 86 ? geopotential_regime(h) : geometric_regime(h);
    air.vapour_density_g_m3 = sea_level_vapour_g_m3 * std::exp(-h / 2);
    return air;
}

ReferenceAir with_least_vapour(ReferenceAir air) {
    const double least = 2e-6 * air.pressure_hpa * 216.7 / air.temperature.value();
    air.vapour_density_g_m3 = std::max(air.vapour_density_g_m3, least);
    return air;
}

Refractivity refractivity_p453(double dry_pressure_hpa, Kelvin temperature, double vapour_pressure_hpa) {
    const double t = temperature.value();
    return {77.6 * dry_pressure_hpa / t, (72 + 3.75e5 / t) * vapour_pressure_hpa / t};
}

}  // namespace skyloop::inline world
