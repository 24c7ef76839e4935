#include "world/propagation/gas_attenuation_p676.hpp"

#include <algorithm>
#include <cmath>

#include "detail/gas_attenuation_p676_table.hpp"
#include "world/propagation/refractivity.hpp"

namespace skyloop {
namespace {

// Van Vleck and Weisskopf's line shape (P.676-13, equation 5). Frequencies and width in GHz.
double line_shape(double f, double f0, double width, double interference) {
    const double below = f0 - f, above = f0 + f, square_width = width * width;
    return f / f0 *
           ((width - interference * below) / (below * below + square_width) +
            (width - interference * above) / (above * above + square_width));
}

// The air in the symbols of P.676: dry pressure and vapour pressure, hPa, and θ = 300/T.
struct P676Air {
    double p, e, theta;
};

double oxygen_refractivity(const P676Air& air, double f) {
    const double cube = std::pow(air.theta, 3), usual_power = std::pow(air.theta, 0.8);
    double sum = 0;
    for (const OxygenLine& line : oxygen_lines_p676) {
        const double strength = line.a1 * 1e-7 * air.p * cube * std::exp(line.a2 * (1 - air.theta));
        const double power = line.a4 == 0 ? usual_power : std::pow(air.theta, 0.8 - line.a4);
        const double pressure_width = line.a3 * 1e-4 * (air.p * power + 1.1 * air.e * air.theta);
        const double width = std::sqrt(pressure_width * pressure_width + 2.25e-6);  // Zeeman splitting
        const double interference = (line.a5 + line.a6 * air.theta) * 1e-4 * (air.p + air.e) * usual_power;
        sum += strength * line_shape(f, line.f0, width, interference);
    }
    return sum;
}

double vapour_refractivity(const P676Air& air, double f) {
    const double strength_power = std::pow(air.theta, 3.5), logarithm = std::log(air.theta);
    double sum = 0;
    for (const VapourLine& line : vapour_lines_p676) {
        const double strength = line.b1 * 1e-1 * air.e * strength_power * std::exp(line.b2 * (1 - air.theta));
        const double pressure_width =
            line.b3 * 1e-4 * (air.p * std::exp(line.b4 * logarithm) + line.b5 * air.e * std::exp(line.b6 * logarithm));
        const double doppler = 2.1316e-12 * line.f0 * line.f0 / air.theta;
        const double width = 0.535 * pressure_width + std::sqrt(0.217 * pressure_width * pressure_width + doppler);
        sum += strength * line_shape(f, line.f0, width, 0);
    }
    return sum;
}

// Debye spectrum of oxygen below 10 GHz and pressure-induced nitrogen above 100 GHz (P.676-13, equations 8 and 9).
double dry_continuum(const P676Air& air, double f) {
    const double d = 5.6e-4 * (air.p + air.e) * std::pow(air.theta, 0.8);
    const double debye = 6.14e-5 / (d * (1 + f / d * f / d));
    const double nitrogen = 1.4e-12 * air.p * std::pow(air.theta, 1.5) / (1 + 1.9e-5 * std::pow(f, 1.5));
    return f * air.p * air.theta * air.theta * (debye + nitrogen);
}

constexpr double p676_earth_radius_km = 6371;
constexpr double p676_top_km = 100;

}  // namespace

GasAttenuation gas_attenuation_p676(const ReferenceAir& air, Hertz carrier) {
    const double f = carrier.value() / 1e9;
    const P676Air symbols{air.dry_pressure_hpa(), air.vapour_pressure_hpa(), 300 / air.temperature.value()};
    const double per_refractivity = 0.1820 * f;
    return {DecibelsPerKilometre(per_refractivity * (oxygen_refractivity(symbols, f) + dry_continuum(symbols, f))),
            DecibelsPerKilometre(per_refractivity * vapour_refractivity(symbols, f))};
}

Decibels slant_gas_attenuation_p676(Hertz carrier, Angle apparent, Metres antenna_height) {
    return slant_gas_attenuation_p676(carrier, std::span<const Angle>(&apparent, 1), antenna_height).front();
}

std::vector<Decibels> slant_gas_attenuation_p676(Hertz carrier, std::span<const Angle> apparent,
                                                 Metres antenna_height) {
    double height_km = std::clamp(antenna_height.value() / 1000, 0.0, p676_top_km);
    double thickness = 0.0001;
    std::vector<double> invariants(apparent.size(), 0.0);  // n r sin of the angle to the vertical, Bouguer's law
    std::vector<Decibels> losses(apparent.size());
    while (height_km < p676_top_km) {
        const double step = std::min(thickness, p676_top_km - height_km);
        const ReferenceAir air = with_least_vapour(reference_atmosphere_p835(Metres((height_km + step / 2) * 1000)));
        const double index =
            1 + 1e-6 * refractivity_p453(air.dry_pressure_hpa(), air.temperature, air.vapour_pressure_hpa()).total();
        const DecibelsPerKilometre attenuation = gas_attenuation_p676(air, carrier).total();
        const double base = p676_earth_radius_km + height_km;
        const double top = base + step;
        for (std::size_t i = 0; i < apparent.size(); ++i) {
            if (invariants[i] == 0) invariants[i] = index * base * std::cos(apparent[i].rad());
            // A ray that the next layer would turn back is kept level instead.
            const double level = std::min(invariants[i] / index, base);
            const double path = std::sqrt(top * top - level * level) - std::sqrt(base * base - level * level);
            losses[i] += loss_over(attenuation, Metres(path * 1000));
        }
        height_km += step;
        thickness *= std::exp(0.01);
    }
    return losses;
}

}  // namespace skyloop
