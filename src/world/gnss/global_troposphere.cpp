#include "world/gnss/global_troposphere.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "detail/gmf_gpt_table.hpp"

namespace skyloop {
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
    return of_modified_julian_date(static_cast<double>(modified_julian_day(utc)) + utc.seconds_of_day() / 86400);
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

TroposphereMapping gmf_mapping(const Geodetic& place, AnnualPhase phase, Angle elevation) {
    TroposphereMapping mapping = vmf1_mapping(gmf_coefficients(place, phase), place.latitude, phase, elevation);
    mapping.hydrostatic += niell_height_correction({place.height.above_ellipsoid}, elevation);
    return mapping;
}

MappingCoefficients vmf1_hydrostatic(double a_hydrostatic, Angle latitude, AnnualPhase phase) {
    const bool south = latitude.rad() < 0;
    const double c11 = south ? 0.007 : 0.005, c10 = south ? 0.002 : 0.001;
    const double wave = (south ? -phase.cosine() : phase.cosine()) + 1;
    return {a_hydrostatic, 0.0029, 0.062 + (wave * c11 / 2 + c10) * (1 - std::cos(latitude.rad()))};
}

MappingCoefficients vmf1_wet(double a_wet) { return {a_wet, 0.00146, 0.04391}; }

TroposphereMapping vmf1_mapping(const Vmf1Coefficients& a, Angle latitude, AnnualPhase phase, Angle elevation) {
    return {marini(vmf1_hydrostatic(a.a_hydrostatic, latitude, phase), elevation),
            marini(vmf1_wet(a.a_wet), elevation)};
}

}  // namespace skyloop
