#include "receiver/pvt/corrections.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "world/gnss/constants.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop::inline receiver {
namespace {

constexpr Angle lowest_divisor = Angle::degrees(0.1);  // of 1/sin e

MslHeight sea_level_height(const Geodetic& place, const Geoid* geoid) {
    return above_sea_level(place.height, geoid ? geoid->undulation(place.latitude, place.longitude) : Metres(0));
}

double power_series(const std::array<double, 4>& c, double x) { return c[0] + x * (c[1] + x * (c[2] + x * c[3])); }

}  // namespace

const KlobucharCoefficients& default_klobuchar_coefficients() {
    // brdc0010.04n of the IGS; the same day stands in RTKLIB for files without coefficients.
    static constexpr KlobucharCoefficients coefficients{{0.1118e-7, -0.7451e-8, -0.5961e-7, 0.1192e-6},
                                                        {0.1167e6, -0.2294e6, -0.1311e6, 0.1049e7}};
    return coefficients;
}

Metres beidou_klobuchar_delay(const KlobucharCoefficients& coefficients, const Geodetic& place,
                              const SkyDirection& direction, GpsTime time) {
    constexpr ThinShell shell{Metres(6378000), Metres(375000)};
    const Geodetic ground{place.latitude, place.longitude, {}};
    const PiercePoint pierce = published_pierce_point(shell, ground, direction);
    const double latitude = std::abs(pierce.latitude.rad()) / std::numbers::pi;
    double local_time =
        std::fmod(43200 * pierce.longitude.rad() / std::numbers::pi + bdt_week_and_tow(time).tow_seconds(), 86400.0);
    if (local_time < 0) local_time += 86400;

    const double amplitude = std::max(0.0, power_series(coefficients.alpha, latitude));
    const double period = std::clamp(power_series(coefficients.beta, latitude), 72000.0, 172800.0);
    const double since_noon = local_time - 50400;
    double vertical_s = 5e-9;
    if (std::abs(since_noon) < period / 4)
        vertical_s += amplitude * std::cos(2 * std::numbers::pi * since_noon / period);
    return Metres(speed_of_light * vertical_s * single_layer_mapping(shell, direction.elevation));
}

SiteCorrections::SiteCorrections(const CorrectionParameters& parameters, const CorrectionKnowledge& knowledge,
                                 const Geodetic& place, GpsTime time)
    : parameters_(parameters),
      knowledge_(knowledge),
      place_(place),
      time_(time),
      height_(sea_level_height(place, knowledge.geoid)) {
    const UtcTime utc = to_utc(time, knowledge.leap_seconds);
    ionosphere_time_ = IonosphereTime::of(utc);
    if (parameters.troposphere == TroposphereCorrection::none) return;
    zenith_ =
        saastamoinen_zenith_delay(standard_weather(height_, parameters.relative_humidity), place.latitude, height_);
    hydrostatic_ = niell_hydrostatic(place.latitude, day_of_year(utc));
    wet_ = niell_wet(place.latitude);
}

const KlobucharCoefficients* SiteCorrections::coefficients_of(Constellation constellation) const {
    const BroadcastIonosphere& heard = knowledge_.ionosphere;
    if (parameters_.ionosphere == IonosphereCorrection::broadcast) {
        if (constellation == Constellation::qzss && heard.qzss) return &*heard.qzss;
        if (constellation == Constellation::navic && heard.navic) return &*heard.navic;
    }
    if (heard.gps) return &*heard.gps;
    return parameters_.default_ionosphere ? &default_klobuchar_coefficients() : nullptr;
}

Metres SiteCorrections::ionosphere(Constellation constellation, const SkyDirection& direction, Hertz carrier) const {
    if (parameters_.ionosphere == IonosphereCorrection::none || direction.elevation <= Angle()) return Metres(0);
    const BroadcastIonosphere& heard = knowledge_.ionosphere;
    if (parameters_.ionosphere == IonosphereCorrection::broadcast) {
        if (constellation == Constellation::galileo && heard.galileo) {
            const auto& a = *heard.galileo;
            const PiercePoint pierce = published_pierce_point({}, {place_.latitude, place_.longitude, {}}, direction);
            return ionosphere_group_delay(
                ntcm_g_content({a[0], a[1], a[2]}, pierce, direction.elevation, ionosphere_time_), carrier);
        }
        if (constellation == Constellation::beidou && heard.beidou) {
            const double ratio = carrier_frequency(Signal::b1i).value() / carrier.value();
            return beidou_klobuchar_delay(*heard.beidou, place_, direction, time_) * (ratio * ratio);
        }
    }
    const KlobucharCoefficients* coefficients = coefficients_of(constellation);
    if (coefficients == nullptr) return Metres(0);
    return ionosphere_delay_at(klobuchar_delay(*coefficients, place_, direction, time_).slant, carrier);
}

Metres SiteCorrections::troposphere(Angle elevation) const {
    const Angle e = std::max(elevation, Angle());
    switch (parameters_.troposphere) {
        case TroposphereCorrection::none:
            return Metres(0);
        case TroposphereCorrection::saastamoinen:
            return zenith_.total() / std::sin(std::max(e, lowest_divisor).rad());
        case TroposphereCorrection::niell:
            return zenith_.hydrostatic * (marini(hydrostatic_, e) + height_correction_to_horizon(height_, e)) +
                   zenith_.wet * marini(wet_, e);
    }
    return Metres(0);
}

}  // namespace skyloop::inline receiver
