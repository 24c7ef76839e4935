#include "detail/nequick_profile.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace skyloop::inline world {
namespace {

constexpr double nequick_height_e = 120;  // of the E peak, km
constexpr double nequick_bottom_e = 5;    // thickness of the E layer's lower side, km

// An exponential that neither overflows nor vanishes.
double clipped_exp(double x) {
    if (x > 80) return 5.5406e34;
    if (x < -80) return 1.8049e-35;
    return std::exp(x);
}

// Goes smoothly from `below` at x << 0 to `above` at x >> 0.
double joined(double above, double below, double sharpness, double x) {
    const double weight = clipped_exp(sharpness * x);
    return (above * weight + below) / (weight + 1);
}

double epstein(double amplitude, double peak, double thickness, double height) {
    const double x = clipped_exp((height - peak) / thickness);
    return amplitude * x / ((1 + x) * (1 + x));
}

double peak_density(double critical_frequency) { return 0.124 * critical_frequency * critical_frequency; }

// Coefficients of place at one time and activity, from those of time by month.
template <std::size_t Places, std::size_t Times>
std::array<double, Places> ccir_at(const CcirMonth::Map<Places, Times>& map, double sunspots, double ut_hours) {
    const double t = Angle::degrees(15 * ut_hours - 180).rad();
    std::array<double, Places> result{};
    for (std::size_t i = 0; i < Places; ++i) {
        const auto at_activity = [&](std::size_t k) {
            return map[0][i][k] * (1 - sunspots / 100) + map[1][i][k] * sunspots / 100;
        };
        result[i] = at_activity(0);
        for (std::size_t k = 1; 2 * k < Times; ++k) {
            const double phase = static_cast<double>(k) * t;
            result[i] += at_activity(2 * k - 1) * std::sin(phase) + at_activity(2 * k) * std::cos(phase);
        }
    }
    return result;
}

// The maps' sum over place: powers of sin(modip) by harmonics of longitude.
template <std::size_t Places, std::size_t Orders>
double ccir_sum(const std::array<double, Places>& coefficients, const std::array<std::size_t, Orders>& degrees,
                const NequickPlace& place) {
    const double s = std::sin(place.modip), c = std::cos(place.latitude);
    auto next = coefficients.begin();
    double sum = 0, zonal = 1;
    for (std::size_t k = 0; k < degrees[0]; ++k, zonal *= s)
        sum += *next++ * zonal;
    double sectoral = 1;
    for (std::size_t n = 1; n < Orders; ++n) {
        sectoral *= c;
        const double phase = static_cast<double>(n) * place.longitude;
        double power = sectoral;
        for (std::size_t k = 0; k < degrees[n]; ++k, power *= s) {
            const double cosine = *next++, sine = *next++;
            sum += (cosine * std::cos(phase) + sine * std::sin(phase)) * power;
        }
    }
    return sum;
}

constexpr std::array<std::size_t, 9> ccir_f2_degrees{12, 12, 9, 5, 2, 1, 1, 1, 1};
constexpr std::array<std::size_t, 7> ccir_m3000_degrees{7, 8, 6, 3, 2, 1, 1};

// The least M(3000)F2, as the Commission's own program has it: below 0.88 the F2 peak has no height.
constexpr double nequick_least_transmission = 1;

// Solar zenith angle at which day turns to night in the E layer, degrees.
constexpr double nequick_day_night = 86.23292796211615;

// -1 in the northern winter, 1 in summer, 0 between.
int nequick_season(int month) {
    if (month <= 2 || month >= 11) return -1;
    return month >= 5 && month <= 8 ? 1 : 0;
}

// foF1 from its neighbours, MHz.
double critical_frequency_f1(double f_e, double f_f2) {
    double f = joined(1.4 * f_e, 0, 1000, f_e - 2);
    f = joined(0, f, 1000, f_e - f);
    f = joined(f, 0.85 * f, 60, 0.85 * f_f2 - f);
    return f < 1e-6 ? 0 : f;
}

}  // namespace

NequickConditions::NequickConditions(const NequickTables& tables, double ionisation, double ut_hours)
    : month_(tables.month),
      ionisation_(ionisation),
      sunspots_(std::sqrt(167273 + (ionisation - 63.7) * 1123.6) - 408.99),
      ut_hours_(ut_hours),
      f2_(ccir_at(tables.ccir.critical_frequency, sunspots_, ut_hours)),
      m3000_(ccir_at(tables.ccir.transmission_factor, sunspots_, ut_hours)) {
    const double day = 30.5 * month_ - 15 + (18 - ut_hours) / 24;
    const double mean = Angle::degrees(0.9856 * day - 3.289).rad();
    const double ecliptic = mean + Angle::degrees(1.916 * std::sin(mean) + 0.020 * std::sin(2 * mean) + 282.634).rad();
    sin_declination_ = 0.39782 * std::sin(ecliptic);
    cos_declination_ = std::sqrt(1 - sin_declination_ * sin_declination_);
}

double NequickConditions::critical_frequency_f2(double modip, double latitude, double longitude) const {
    return ccir_sum(f2_, ccir_f2_degrees, {modip, latitude, longitude});
}

double NequickConditions::transmission_factor(double modip, double latitude, double longitude) const {
    return ccir_sum(m3000_, ccir_m3000_degrees, {modip, latitude, longitude});
}

double NequickConditions::critical_frequency_e(double latitude, double longitude) const {
    const double local_time = ut_hours_ + Angle::radians(longitude).deg() / 15;
    const double cosine = std::sin(latitude) * sin_declination_ +
                          std::cos(latitude) * cos_declination_ * std::cos(std::numbers::pi * (12 - local_time) / 12);
    const double zenith = Angle::radians(std::acos(std::clamp(cosine, -1.0, 1.0))).deg();
    const double effective = joined(90 - 0.24 * clipped_exp(20 - 0.2 * zenith), zenith, 12, zenith - nequick_day_night);
    const double latitude_factor = clipped_exp(0.3 * Angle::radians(latitude).deg());
    const double season = nequick_season(month_) * (latitude_factor - 1) / (latitude_factor + 1);
    const double day = std::pow(std::max(std::cos(Angle::degrees(effective).rad()), 0.0), 0.6);
    return std::sqrt(std::pow(1.112 - 0.019 * season, 2) * std::sqrt(ionisation_) * day + 0.49);
}

NequickProfile::NequickProfile(const NequickConditions& conditions, const NequickPlace& place) {
    const double transmission = std::max(conditions.transmission_factor(place.modip, place.latitude, place.longitude),
                                         nequick_least_transmission);
    Peaks critical{};
    critical.e = conditions.critical_frequency_e(place.latitude, place.longitude);
    critical.f2 = conditions.critical_frequency_f2(place.modip, place.latitude, place.longitude);
    critical.f1 = critical_frequency_f1(critical.e, critical.f2);
    Peaks peak{peak_density(critical.e), peak_density(critical.f1), peak_density(critical.f2)};
    if (critical.f1 <= 0 && critical.e > 2) peak.f1 = peak_density(critical.e + 0.5);

    set_heights(transmission, critical);
    bottom_f2_ =
        38.5 * peak.f2 / std::exp(-3.467 + 0.857 * std::log(critical.f2 * critical.f2) + 2.02 * std::log(transmission));
    set_amplitudes(critical, peak);
    set_topside(conditions, peak.f2);
}

void NequickProfile::set_heights(double m, const Peaks& critical) {
    double correction = -0.012;
    if (critical.e > 1e-30) {
        const double ratio = critical.f2 / critical.e;
        correction += 0.253 / (joined(ratio, 1.75, 20, ratio - 1.75) - 1.215);
    }
    height_f2_ = 1490 * m * std::sqrt((0.0196 * m * m + 1) / (1.2967 * m * m - 1)) / (m + correction) - 176;
    height_f1_ = (height_f2_ + nequick_height_e) / 2;
    top_f1_ = 0.3 * (height_f2_ - height_f1_);
    bottom_f1_ = 0.5 * (height_f1_ - nequick_height_e);
    top_e_ = std::max(bottom_f1_, 7.0);
}

void NequickProfile::set_amplitudes(const Peaks& critical, const Peaks& peak) {
    amplitude_f2_ = 4 * peak.f2;
    const double f2_at_e = epstein(amplitude_f2_, height_f2_, bottom_f2_, nequick_height_e);
    if (critical.f1 < 0.5) {
        amplitude_f1_ = 0;
        amplitude_e_ = 4 * (peak.e - f2_at_e);
    } else {
        const double f2_at_f1 = epstein(amplitude_f2_, height_f2_, bottom_f2_, height_f1_);
        amplitude_e_ = 4 * peak.e;
        // Each layer adds to the other's peak: five rounds settle both.
        for (int round = 0; round < 5; ++round) {
            const double e_at_f1 = epstein(amplitude_e_, nequick_height_e, top_e_, height_f1_);
            const double f1 = 4 * (peak.f1 - f2_at_f1 - e_at_f1);
            amplitude_f1_ = joined(f1, 0.8 * peak.f1, 1, f1 - 0.8 * peak.f1);
            amplitude_e_ = 4 * (peak.e - epstein(amplitude_f1_, height_f1_, bottom_f1_, nequick_height_e) - f2_at_e);
        }
    }
    amplitude_e_ = joined(amplitude_e_, 0.05, 60, amplitude_e_ - 0.005);
}

void NequickProfile::set_topside(const NequickConditions& conditions, double peak_f2) {
    const bool summer = conditions.month() >= 4 && conditions.month() <= 9;
    const double ratio = height_f2_ / bottom_f2_;
    const double shape = summer ? 6.705 - 0.014 * conditions.sunspot_number() - 0.008 * height_f2_
                                : -7.77 + 0.097 * ratio * ratio + 0.153 * peak_f2;
    const double at_least_two = joined(shape, 2, 1, shape - 2);
    const double k = joined(8, at_least_two, 1, at_least_two - 8);
    const double scale = k * bottom_f2_;
    const double x = (scale - 150) / 100;
    scale_above_ = scale / ((0.041163 * x - 0.183981) * x + 1.424472);
}

double NequickProfile::density(double height_km) const {
    return height_km <= height_f2_ ? below_peak(height_km) : above_peak(height_km);
}

double NequickProfile::below_peak(double height_km) const {
    const double h = std::max(height_km, 100.0);
    // Takes the lower layers out around the F2 peak.
    const double fading = clipped_exp(10 / (1 + std::abs(h - height_f2_)));
    struct Layer {
        double amplitude, thickness, x;
    };
    const double thickness_f1 = h > height_f1_ ? top_f1_ : bottom_f1_;
    const double thickness_e = h > nequick_height_e ? top_e_ : nequick_bottom_e;
    const std::array<Layer, 3> layers{{{amplitude_f2_, bottom_f2_, (h - height_f2_) / bottom_f2_},
                                       {amplitude_f1_, thickness_f1, (h - height_f1_) / thickness_f1 * fading},
                                       {amplitude_e_, thickness_e, (h - nequick_height_e) / thickness_e * fading}}};
    double sum = 0, slope = 0;
    for (const Layer& layer : layers) {
        if (std::abs(layer.x) > 25) continue;
        const double e = clipped_exp(layer.x);
        const double s = layer.amplitude * e / ((1 + e) * (1 + e));
        sum += s;
        slope += s * (1 - e) / (1 + e) / layer.thickness;
    }
    if (height_km >= 100 || sum == 0) return sum;
    // Below 100 km the density falls as a Chapman layer that continues its slope.
    const double z = (height_km - 100) / 10;
    return sum * clipped_exp(1 - (1 - 10 * slope / sum) * z - clipped_exp(-z));
}

double NequickProfile::above_peak(double height_km) const {
    constexpr double gradient = 0.125, reach = 100;
    const double above = height_km - height_f2_;
    const double widening = 1 + reach * gradient * above / (reach * scale_above_ + gradient * above);
    const double e = clipped_exp(above / (scale_above_ * widening));
    if (e > 1e11) return amplitude_f2_ / e;
    return amplitude_f2_ * e / ((1 + e) * (1 + e));
}

}  // namespace skyloop::inline world
