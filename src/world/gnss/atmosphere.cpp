#include "world/gnss/atmosphere.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "detail/gmf_gpt_table.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::inline world {
namespace {

constexpr double pi = std::numbers::pi;

// A cubic in semicircles, as the broadcast gives amplitude and period.
double cubic(const std::array<double, 4>& c, double x) { return c[0] + x * (c[1] + x * (c[2] + x * c[3])); }

// Niell's five latitudes and his coefficients there (Niell 1996, tables 3 and 4).
constexpr std::array<double, 5> niell_latitudes_deg{15, 30, 45, 60, 75};
using NiellTable = std::array<MappingCoefficients, 5>;
constexpr NiellTable niell_hydrostatic_average{{
    {1.2769934e-3, 2.9153695e-3, 62.610505e-3},
    {1.2683230e-3, 2.9152299e-3, 62.837393e-3},
    {1.2465397e-3, 2.9288445e-3, 63.721774e-3},
    {1.2196049e-3, 2.9022565e-3, 63.824265e-3},
    {1.2045996e-3, 2.9024912e-3, 64.258455e-3},
}};
constexpr NiellTable niell_hydrostatic_amplitude{{
    {0.0, 0.0, 0.0},
    {1.2709626e-5, 2.1414979e-5, 9.0128400e-5},
    {2.6523662e-5, 3.0160779e-5, 4.3497037e-5},
    {3.4000452e-5, 7.2562722e-5, 84.795348e-5},
    {4.1202191e-5, 11.723375e-5, 170.37206e-5},
}};
constexpr NiellTable niell_wet_average{{
    {5.8021897e-4, 1.4275268e-3, 4.3472961e-2},
    {5.6794847e-4, 1.5138625e-3, 4.6729510e-2},
    {5.8118019e-4, 1.4572752e-3, 4.3908931e-2},
    {5.9727542e-4, 1.5007428e-3, 4.4626982e-2},
    {6.1641693e-4, 1.7599082e-3, 5.4736038e-2},
}};
constexpr MappingCoefficients niell_height{2.53e-5, 5.49e-3, 1.14e-3};
constexpr double niell_phase_day = 28;

MappingCoefficients weighted_sum(const MappingCoefficients& x, double wx, const MappingCoefficients& y, double wy) {
    return {wx * x.a + wy * y.a, wx * x.b + wy * y.b, wx * x.c + wy * y.c};
}

// Linear in |latitude| between the table's rows, constant beyond them.
MappingCoefficients at_latitude(const NiellTable& table, Angle latitude) {
    const double degrees = std::abs(latitude.deg());
    if (degrees <= niell_latitudes_deg.front()) return table.front();
    if (degrees >= niell_latitudes_deg.back()) return table.back();
    const double step = niell_latitudes_deg[1] - niell_latitudes_deg[0];
    const double row = (degrees - niell_latitudes_deg.front()) / step;
    const auto below = std::min(static_cast<std::size_t>(row), table.size() - 2);
    const double fraction = row - static_cast<double>(below);
    return weighted_sum(table[below], 1 - fraction, table[below + 1], fraction);
}

}  // namespace

KlobucharDelay klobuchar_delay(const KlobucharCoefficients& coefficients, const Geodetic& place,
                               const SkyDirection& direction, GpsTime time) {
    // Angles in semicircles, as the interface document counts them.
    const double elevation = direction.elevation.rad() / pi;
    const double earth_angle = 0.0137 / (elevation + 0.11) - 0.022;
    const double latitude =
        std::clamp(place.latitude.rad() / pi + earth_angle * std::cos(direction.azimuth.rad()), -0.416, 0.416);
    const double longitude =
        place.longitude.rad() / pi + earth_angle * std::sin(direction.azimuth.rad()) / std::cos(latitude * pi);
    const double geomagnetic_latitude = latitude + 0.064 * std::cos((longitude - 1.617) * pi);
    double local_time = std::fmod(43200 * longitude + week_and_tow(time).tow_seconds(), 86400.0);
    if (local_time < 0) local_time += 86400;

    const double period = std::max(72000.0, cubic(coefficients.beta, geomagnetic_latitude));
    const double amplitude = std::max(0.0, cubic(coefficients.alpha, geomagnetic_latitude));
    const double x = 2 * pi * (local_time - 50400) / period;
    double vertical_s = 5e-9;
    if (std::abs(x) < 1.57) vertical_s += amplitude * (1 - x * x / 2 + x * x * x * x / 24);

    const double slant_factor = 1 + 16 * std::pow(0.53 - elevation, 3);
    const Metres vertical(speed_of_light * vertical_s);
    return {vertical, vertical * slant_factor};
}

Metres ionosphere_delay_at(Metres delay_l1, Hertz carrier) {
    const double ratio = carrier_frequency_l1 / carrier.value();
    return delay_l1 * (ratio * ratio);
}

double marini(const MappingCoefficients& m, Angle elevation) {
    const double s = std::sin(elevation.rad());
    return (1 + m.a / (1 + m.b / (1 + m.c))) / (s + m.a / (s + m.b / (s + m.c)));
}

MappingCoefficients niell_hydrostatic(Angle latitude, double day_of_year) {
    // Winter comes half a year later in the south.
    const double year_phase = (day_of_year - niell_phase_day) / 365.25 + (latitude.rad() < 0 ? 0.5 : 0.0);
    return weighted_sum(at_latitude(niell_hydrostatic_average, latitude), 1,
                        at_latitude(niell_hydrostatic_amplitude, latitude), -std::cos(2 * pi * year_phase));
}

MappingCoefficients niell_wet(Angle latitude) { return at_latitude(niell_wet_average, latitude); }

double niell_height_correction(MslHeight height, Angle elevation) {
    const double height_km = height.above_sea_level.value() / 1000;
    return (1 / std::sin(elevation.rad()) - marini(niell_height, elevation)) * height_km;
}

namespace {

// Marini's fraction and its slope over sin e.
struct MariniTangent {
    double value = 0, slope = 0;
};

MariniTangent marini_tangent(const MappingCoefficients& m, Angle elevation) {
    const double s = std::sin(elevation.rad());
    const double inner = s + m.c, middle = s + m.b / inner, outer = s + m.a / middle;
    const double middle_slope = 1 - m.b / (inner * inner);
    const double outer_slope = 1 - m.a / (middle * middle) * middle_slope;
    const double value = marini(m, elevation);
    return {value, -value / outer * outer_slope};
}

}  // namespace

double height_correction_to_horizon(MslHeight height, Angle elevation) {
    constexpr Angle lowest_fitted = Angle::degrees(3);
    if (elevation >= lowest_fitted) return niell_height_correction(height, elevation);
    const double from = std::sin(lowest_fitted.rad());
    const double slope = -1 / (from * from) - marini_tangent(niell_height, lowest_fitted).slope;
    const double height_km = height.above_sea_level.value() / 1000;
    return niell_height_correction(height, lowest_fitted) + slope * (std::sin(elevation.rad()) - from) * height_km;
}

double niell_hydrostatic_mapping(const MappingSite& site, Angle elevation) {
    return marini(niell_hydrostatic(site.latitude, site.day_of_year), elevation) +
           niell_height_correction(site.height, elevation);
}

double niell_wet_mapping(Angle latitude, Angle elevation) { return marini(niell_wet(latitude), elevation); }

SurfaceWeather standard_weather(MslHeight height, double relative_humidity) {
    // Above 40 km the power law would leave the reals; there is no weather there.
    const double h = std::clamp(height.above_sea_level.value(), 0.0, 40000.0);
    SurfaceWeather weather;
    weather.pressure_hpa = 1013.25 * std::pow(1 - 2.2557e-5 * h, 5.2568);
    const double t = 288.16 - 6.5e-3 * h;
    weather.temperature = Kelvin(t);
    // The saturation formula has its pole at 38.45 K; cold air holds nothing long before.
    weather.vapour_pressure_hpa = t > 100 ? 6.108 * relative_humidity * std::exp((17.15 * t - 4684) / (t - 38.45)) : 0;
    return weather;
}

Metres zenith_hydrostatic_delay(double pressure_hpa, Angle latitude, MslHeight height) {
    const double height_km = std::max(height.above_sea_level.value(), 0.0) / 1000;
    return Metres(0.0022768 * pressure_hpa / (1 - 0.00266 * std::cos(2 * latitude.rad()) - 0.00028 * height_km));
}

Metres zenith_wet_delay(const SurfaceWeather& weather) {
    return Metres(0.002277 * (1255 / weather.temperature.value() + 0.05) * weather.vapour_pressure_hpa);
}

ZenithDelay saastamoinen_zenith_delay(const SurfaceWeather& weather, Angle latitude, MslHeight height) {
    return {zenith_hydrostatic_delay(weather.pressure_hpa, latitude, height), zenith_wet_delay(weather)};
}

Metres saastamoinen_delay(Angle latitude, MslHeight height, Angle elevation, double relative_humidity) {
    const ZenithDelay zenith = saastamoinen_zenith_delay(standard_weather(height, relative_humidity), latitude, height);
    return zenith.total() / std::sin(elevation.rad());
}

namespace {

// P_nm(sin φ) cos mλ and P_nm(sin φ) sin mλ up to degree and order 9.
class SphericalHarmonics {
public:
    SphericalHarmonics(Angle latitude, Angle longitude) {
        const double x = std::cos(latitude.rad()) * std::cos(longitude.rad());
        const double y = std::cos(latitude.rad()) * std::sin(longitude.rad());
        const double z = std::sin(latitude.rad());
        at(0, 0) = {1, 0};
        for (int m = 0; m <= degree; ++m) {
            if (m > 0) {
                const HarmonicPair last = at(m - 1, m - 1);
                const double factor = 2 * m - 1;
                at(m, m) = {factor * (x * last.cosine - y * last.sine), factor * (x * last.sine + y * last.cosine)};
            }
            if (m < degree) at(m + 1, m) = scaled(at(m, m), (2 * m + 1) * z);
            for (int n = m + 2; n <= degree; ++n) {
                const HarmonicPair one = scaled(at(n - 1, m), (2 * n - 1) * z / (n - m));
                const HarmonicPair two = scaled(at(n - 2, m), double(n + m - 1) / (n - m));
                at(n, m) = {one.cosine - two.cosine, one.sine - two.sine};
            }
        }
    }

    [[nodiscard]] double sum(HarmonicPair GmfGptTerm::*field) const {
        double total = 0;
        for (const GmfGptTerm& term : gmf_gpt_terms) {
            const HarmonicPair& here = values_[index(term.n, term.m)];
            total += (term.*field).cosine * here.cosine + (term.*field).sine * here.sine;
        }
        return total;
    }

private:
    static constexpr int degree = 9;
    static std::size_t index(int n, int m) {
        return static_cast<std::size_t>(n) * (degree + 1) + static_cast<std::size_t>(m);
    }
    HarmonicPair& at(int n, int m) { return values_[index(n, m)]; }
    static HarmonicPair scaled(const HarmonicPair& pair, double factor) {
        return {pair.cosine * factor, pair.sine * factor};
    }
    std::array<HarmonicPair, (degree + 1) * (degree + 1)> values_;
};

}  // namespace

AnnualPhase AnnualPhase::of(const UtcTime& utc) {
    return {static_cast<double>(modified_julian_day(utc)) + utc.seconds_of_day() / 86400 - 44266};
}

double AnnualPhase::cosine() const { return std::cos(days / 365.25 * 2 * std::numbers::pi); }

GptWeather gpt_weather(const Geodetic& place, AnnualPhase phase) {
    const SphericalHarmonics harmonics(place.latitude, place.longitude);
    GptWeather weather;
    weather.undulation = Metres(harmonics.sum(&GmfGptTerm::undulation));
    const double height = (place.height.above_ellipsoid - weather.undulation).value();
    const double pressure =
        harmonics.sum(&GmfGptTerm::pressure_mean) + harmonics.sum(&GmfGptTerm::pressure_amplitude) * phase.cosine();
    const double temperature = harmonics.sum(&GmfGptTerm::temperature_mean) +
                               harmonics.sum(&GmfGptTerm::temperature_amplitude) * phase.cosine();
    // Beyond the height at which the power law ends there is no air.
    weather.pressure_hpa = pressure * std::pow(std::max(1 - 0.0000226 * height, 0.0), 5.225);
    weather.temperature_celsius = temperature - 0.0065 * height;
    return weather;
}

Vmf1Coefficients gmf_coefficients(const Geodetic& place, AnnualPhase phase) {
    const SphericalHarmonics harmonics(place.latitude, place.longitude);
    const auto field = [&](HarmonicPair GmfGptTerm::*mean, HarmonicPair GmfGptTerm::*amplitude) {
        return (harmonics.sum(mean) + harmonics.sum(amplitude) * phase.cosine()) * 1e-5;
    };
    return {field(&GmfGptTerm::hydrostatic_mean, &GmfGptTerm::hydrostatic_amplitude),
            field(&GmfGptTerm::wet_mean, &GmfGptTerm::wet_amplitude)};
}

MappingCoefficients vmf1_hydrostatic(double a_hydrostatic, Angle latitude, AnnualPhase phase) {
    const bool south = latitude.rad() < 0;
    const double c11 = south ? 0.007 : 0.005, c10 = south ? 0.002 : 0.001;
    const double wave = (south ? -phase.cosine() : phase.cosine()) + 1;
    return {a_hydrostatic, 0.0029, 0.062 + (wave * c11 / 2 + c10) * (1 - std::cos(latitude.rad()))};
}

MappingCoefficients vmf1_wet(double a_wet) { return {a_wet, 0.00146, 0.04391}; }

}  // namespace skyloop::inline world
