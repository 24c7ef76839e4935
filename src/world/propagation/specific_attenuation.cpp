#include "world/propagation/specific_attenuation.hpp"

#include <array>
#include <cmath>
#include <span>

namespace skyloop::inline world {
namespace {

// One bell of P.838-3's sums: height, centre and width on a logarithmic frequency axis.
struct RainTerm {
    double a, b, c;
};
// A sum of bells and a straight line.
struct RainCurve {
    std::span<const RainTerm> terms;
    double m, q;
};

// P.838-3, tables 1 to 4.
constexpr std::array<RainTerm, 4> k_horizontal_terms{{{-5.33980, -0.10008, 1.13098},
                                                      {-0.35351, 1.26970, 0.45400},
                                                      {-0.23789, 0.86036, 0.15354},
                                                      {-0.94158, 0.64552, 0.16817}}};
constexpr std::array<RainTerm, 4> k_vertical_terms{{{-3.80595, 0.56934, 0.81061},
                                                    {-3.44965, -0.22911, 0.51059},
                                                    {-0.39902, 0.73042, 0.11899},
                                                    {0.50167, 1.07319, 0.27195}}};
constexpr std::array<RainTerm, 5> alpha_horizontal_terms{{{-0.14318, 1.82442, -0.55187},
                                                          {0.29591, 0.77564, 0.19822},
                                                          {0.32177, 0.63773, 0.13164},
                                                          {-5.37610, -0.96230, 1.47828},
                                                          {16.1721, -3.29980, 3.43990}}};
constexpr std::array<RainTerm, 5> alpha_vertical_terms{{{-0.07771, 2.33840, -0.76284},
                                                        {0.56727, 0.95545, 0.54039},
                                                        {-0.20238, 1.14520, 0.26809},
                                                        {-48.2991, 0.791669, 0.116226},
                                                        {48.5833, 0.791459, 0.116479}}};
constexpr RainCurve k_horizontal{k_horizontal_terms, -0.18961, 0.71147};
constexpr RainCurve k_vertical{k_vertical_terms, -0.16398, 0.63297};
constexpr RainCurve alpha_horizontal{alpha_horizontal_terms, 0.67849, -1.95537};
constexpr RainCurve alpha_vertical{alpha_vertical_terms, -0.053739, 0.83433};

double rain_curve(const RainCurve& curve, double log_frequency_ghz) {
    double sum = curve.m * log_frequency_ghz + curve.q;
    for (const RainTerm& term : curve.terms) {
        const double x = (log_frequency_ghz - term.b) / term.c;
        sum += term.a * std::exp(-x * x);
    }
    return sum;
}

double square(double x) { return x * x; }

}  // namespace

Metres scale_height(const AtmosphereParameters& a) {
    return Metres(a.gas_constant * a.sea_level_temperature.value() / (a.gravity_mps2 * a.molar_mass_kg_per_mol));
}

double concentration_at(Metres height, const AtmosphereParameters& atmosphere) {
    return std::exp(-height.value() / scale_height(atmosphere).value());
}

double layer_concentration(const AtmosphericLayer& layer, const AtmosphereParameters& atmosphere) {
    switch (layer.concentration) {
        case ConcentrationMode::fixed:
            return layer.fixed_concentration;
        case ConcentrationMode::midpoint:
            return concentration_at((layer.base + layer.top) * 0.5, atmosphere);
        case ConcentrationMode::mean:
            break;
    }
    const double thickness = (layer.top - layer.base).value();
    if (thickness <= 0) return concentration_at(layer.base, atmosphere);
    return scale_height(atmosphere).value() / thickness *
           (concentration_at(layer.base, atmosphere) - concentration_at(layer.top, atmosphere));
}

DecibelsPerKilometre oxygen_attenuation(Hertz carrier, double concentration, double constant) {
    const double f = carrier.value() / 1e9;
    const double lines = 7.19e-3 + 6.09 / (f * f + constant) + 4.81 / (square(f - 57) + 1.5);
    return DecibelsPerKilometre(lines * concentration * f * f * 1e-3);
}

DecibelsPerKilometre vapour_attenuation(Hertz carrier, double density_g_m3, double concentration) {
    const double f = carrier.value() / 1e9;
    const double density = concentration * density_g_m3;
    const double lines = 0.05 + 0.0021 * density + 3.6 / (square(f - 22.2) + 8.5) + 10.6 / (square(f - 183.3) + 9.0) +
                         8.9 / (square(f - 325.4) + 26.3);
    return DecibelsPerKilometre(lines * f * f * density * 1e-4);
}

RainCoefficients rain_coefficients(Hertz carrier, Angle elevation, Angle tilt) {
    const double log_f = std::log10(carrier.value() / 1e9);
    const double kh = std::pow(10, rain_curve(k_horizontal, log_f));
    const double kv = std::pow(10, rain_curve(k_vertical, log_f));
    const double ah = rain_curve(alpha_horizontal, log_f);
    const double av = rain_curve(alpha_vertical, log_f);
    const double geometry = square(std::cos(elevation.rad())) * std::cos(2 * tilt.rad());
    const double k = (kh + kv + (kh - kv) * geometry) / 2;
    return {k, (kh * ah + kv * av + (kh * ah - kv * av) * geometry) / (2 * k)};
}

DecibelsPerKilometre rain_attenuation(const Rain& rain, Hertz carrier, Angle elevation) {
    if (rain.rate_mm_h <= 0) return DecibelsPerKilometre(0);
    if (rain.model == RainModel::as_vapour)
        return vapour_attenuation(carrier, 0.072 * std::pow(rain.rate_mm_h, 0.88), 1.0);
    const RainCoefficients c = rain_coefficients(carrier, elevation);
    return DecibelsPerKilometre(c.k * std::pow(rain.rate_mm_h, c.alpha));
}

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

}  // namespace skyloop::inline world
