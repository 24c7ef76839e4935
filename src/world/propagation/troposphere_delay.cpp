#include "world/propagation/troposphere_delay.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "world/propagation/ray_geometry.hpp"
#include "world/propagation/reference_air.hpp"

namespace skyloop::inline world {
namespace {

// A ray's vapour is taken there: in the middle of the turbulent layer.
constexpr Metres wet_height{1000};
constexpr NoiseOctave wet_octaves[] = {{Metres(220), 0.02736},   {Metres(1320), 0.08112},   {Metres(7920), 0.18034},
                                       {Metres(47520), 0.31329}, {Metres(285120), 0.52381}, {Metres(1710720), 0.76651}};
constexpr double vapour_scale_height_m = 2000;  // of the reference atmosphere (P.835, 1.2)

// The share of the vapour over the sea that still lies above: what departs of the delay goes with it.
double vapour_above(MslHeight height) {
    return std::exp(-std::max(height.above_sea_level.value(), 0.0) / vapour_scale_height_m);
}

// A mapping function whose coefficients have been found for one epoch.
struct EpochMapping {
    MappingCoefficients hydrostatic, wet;
    std::optional<MslHeight> height;  // of a mapping that is made for sea level

    [[nodiscard]] TroposphereMapping at(Angle elevation) const {
        TroposphereMapping mapping{marini(hydrostatic, elevation), marini(wet, elevation)};
        if (height) mapping.hydrostatic += height_correction_to_horizon(*height, elevation);
        return mapping;
    }
};

EpochMapping epoch_mapping(const TroposphereParameters& parameters, const Geodetic& place, MslHeight height,
                           const UtcTime& utc) {
    const AnnualPhase phase = AnnualPhase::of(utc);
    const auto vienna = [&](const Vmf1Coefficients& a, std::optional<MslHeight> correction) {
        return EpochMapping{vmf1_hydrostatic(a.a_hydrostatic, place.latitude, phase), vmf1_wet(a.a_wet), correction};
    };
    switch (parameters.mapping) {
        case TroposphereMappingModel::gmf:
            return vienna(gmf_coefficients(place, phase), MslHeight{place.height.above_ellipsoid});
        case TroposphereMappingModel::vmf1:
            return vienna(parameters.vmf1, std::nullopt);
        case TroposphereMappingModel::cosecant:  // has no coefficients
            return {};
        case TroposphereMappingModel::niell:
            break;
    }
    return {niell_hydrostatic(place.latitude, day_of_year(utc)), niell_wet(place.latitude), height};
}

double vapour_pressure(double relative_humidity, Kelvin temperature) {
    // The saturation pressure of the standard atmosphere (Saastamoinen 1972), so that the sources agree.
    const double t = temperature.value();
    return t > 100 ? 6.108 * relative_humidity * std::exp((17.15 * t - 4684) / (t - 38.45)) : 0;
}

double gradient_delay(const TroposphereParameters& parameters, const SkyDirection& direction) {
    if (parameters.gradient_north.value() == 0 && parameters.gradient_east.value() == 0) return 0;
    const double e = direction.elevation.rad(), azimuth = direction.azimuth.rad();
    return (parameters.gradient_north.value() * std::cos(azimuth) +
            parameters.gradient_east.value() * std::sin(azimuth)) /
           (std::sin(e) * std::tan(e) + 0.0032);
}

}  // namespace

Metres wet_delay_deviation(const TroposphereParameters& parameters, const AtmosphereParameters& atmosphere) {
    const bool tower = std::any_of(atmosphere.clouds.begin(), atmosphere.clouds.end(),
                                   [](const CloudDeck& deck) { return deck.kind == "thunderstorm"; });
    if (tower || atmosphere.rain.rate_mm_h >= parameters.thunderstorm_rain_mm_h)
        return parameters.residual_in_thunderstorm;
    return atmosphere.rain.rate_mm_h > 0 ? parameters.residual_in_rain : parameters.residual;
}

WetField::WetField(std::uint64_t key, MetresPerSecond wind) : field_(key, wet_octaves, wind) {}

double WetField::at(const SatelliteInView& satellite, const TruthState& truth) {
    // The sphere follows the ellipsoid's height, so that the layer does not lean.
    const Metres radius = Metres(truth.position.vector().norm()) - truth.geodetic.height.above_ellipsoid + wet_height;
    FieldMemory& memory = memories_.of(satellite.id, [](SatelliteId) { return FieldMemory{}; });
    return field_.at(sphere_crossing(truth, satellite, radius), truth.time, memory);
}

SurfaceWeather troposphere_weather(const TroposphereParameters& parameters, const Geodetic& place, MslHeight height,
                                   AnnualPhase phase) {
    switch (parameters.weather) {
        case WeatherSource::gpt: {
            const GptWeather climate = gpt_weather(place, phase);
            const Kelvin temperature(climate.temperature_celsius + 273.15);
            return {climate.pressure_hpa, temperature, vapour_pressure(parameters.relative_humidity, temperature)};
        }
        case WeatherSource::given:
            return {parameters.pressure_hpa, parameters.temperature,
                    vapour_pressure(parameters.relative_humidity, parameters.temperature)};
        case WeatherSource::p835: {
            const ReferenceAir air =
                reference_atmosphere_p835(height.above_sea_level, parameters.sea_level_vapour_g_m3);
            return {air.pressure_hpa, air.temperature, air.vapour_pressure_hpa()};
        }
        case WeatherSource::standard:
            break;
    }
    return standard_weather(height, parameters.relative_humidity);
}

TroposphereDelay::TroposphereDelay(const ModernPropagationParameters& parameters,
                                   const AtmosphereParameters& atmosphere, Site site, std::uint64_t seed)
    : parameters_(parameters.troposphere_model),
      site_(std::move(site)),
      factor_(parameters.troposphere.factor()),
      deviation_(wet_delay_deviation(parameters_, atmosphere) * parameters.troposphere_residual.factor()),
      field_(noise_key(parameters.troposphere_residual.seed.value_or(seed), "troposphere_residual.field"),
             parameters_.wind) {}

void TroposphereDelay::apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) {
    if (factor_ == 0 && deviation_ == Metres(0)) return;
    const UtcTime utc = to_utc(truth.time, site_.leap_seconds);
    const AnnualPhase phase = AnnualPhase::of(utc);
    const MslHeight height = sea_level_height(truth.geodetic, site_.geoid);
    ZenithDelay zenith = saastamoinen_zenith_delay(troposphere_weather(parameters_, truth.geodetic, height, phase),
                                                   truth.geodetic.latitude, height);
    zenith.hydrostatic = zenith.hydrostatic * factor_;
    zenith.wet = zenith.wet * factor_;
    const Metres deviation = deviation_ * vapour_above(height);
    const EpochMapping mapping = epoch_mapping(parameters_, truth.geodetic, height, utc);
    for_each_arrival(arrivals, sky, [&](Arrival& arrival, const SatelliteInView& satellite) {
        const SkyDirection direction{satellite.azimuth, std::max(satellite.elevation, Angle())};
        ZenithDelay above = zenith;
        if (deviation != Metres(0)) above.wet += deviation * field_.at(satellite, truth);
        Metres& delay = arrival.tropo_delay;
        if (parameters_.mapping == TroposphereMappingModel::cosecant) {
            // The very numbers of saastamoinen_delay(), bit by bit.
            delay = above.total() / std::sin(above_horizon(direction.elevation).rad());
        } else {
            const TroposphereMapping m = mapping.at(direction.elevation);
            delay = above.hydrostatic * m.hydrostatic + above.wet * m.wet;
        }
        if (factor_ != 0) delay += Metres(factor_ * gradient_delay(parameters_, direction));
    });
}

}  // namespace skyloop::inline world
