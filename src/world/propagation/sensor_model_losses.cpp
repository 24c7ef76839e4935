#include "world/propagation/sensor_model_losses.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "world/gnss/constants.hpp"
#include "world/propagation/gas_attenuation_p676.hpp"
#include "world/propagation/ray_geometry.hpp"
#include "world/propagation/reference_air.hpp"

namespace skyloop::inline world {
namespace {

template <class Shells>
Decibels loss_through(const Shells& shells, const SphericalRay& ray) {
    Decibels loss;
    for (const auto& shell : shells)
        loss += loss_over(shell.attenuation, shell_path(ray, shell.base, shell.top));
    return loss;
}

}  // namespace

LayeredAtmosphereLoss::LayeredAtmosphereLoss(AtmosphereParameters atmosphere) : atmosphere_(std::move(atmosphere)) {
    if (atmosphere_.layers.empty()) atmosphere_.layers = default_layers();
}

std::vector<LayeredAtmosphereLoss::Shell> LayeredAtmosphereLoss::air_above(Metres antenna_height, Hertz carrier) const {
    std::vector<Shell> shells;
    for (AtmosphericLayer layer : atmosphere_.layers) {
        layer.base = std::max(layer.base, antenna_height);
        if (!layer.enabled || layer.top <= layer.base) continue;
        const double k = layer_concentration(layer, atmosphere_);
        shells.push_back({layer.base, layer.top,
                          oxygen_attenuation(carrier, k, atmosphere_.oxygen_constant) +
                              vapour_attenuation(carrier, layer.vapour_g_m3, k)});
    }
    return shells;
}

std::vector<LayeredAtmosphereLoss::Shell> LayeredAtmosphereLoss::clouds_above(Metres antenna_height,
                                                                              Hertz carrier) const {
    std::vector<Shell> shells;
    for (const CloudDeck& deck : atmosphere_.clouds) {
        const AtmosphericLayer part{deck.kind, std::max(deck.base, antenna_height), deck.top};
        if (part.top <= part.base) continue;
        // A cloud's density is already that of its height (MODELS.md D-13).
        const double k = atmosphere_.clouds_apply_concentration ? layer_concentration(part, atmosphere_) : 1.0;
        shells.push_back({part.base, part.top, vapour_attenuation(carrier, deck.density_g_m3, k)});
    }
    return shells;
}

void LayeredAtmosphereLoss::apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) {
    const Metres height = truth.geodetic.height.above_ellipsoid;
    PerCarrier<Shells> shells;
    for_each_arrival(arrivals, sky, [&](Arrival& arrival, const SatelliteInView& satellite) {
        const Hertz carrier = first_carrier(arrival);
        const Shells& above = shells.of(carrier, [&](Hertz f) {
            return Shells{air_above(height, f), clouds_above(height, f)};
        });
        const SphericalRay ray{satellite.elevation, height, atmosphere_.earth_radius};
        arrival.gas_loss = loss_through(above.air, ray);
        arrival.cloud_loss = loss_through(above.clouds, ray);
        arrival.rain_loss = loss_over(rain_attenuation(atmosphere_.rain, carrier, ray.elevation),
                                      path_to_height(ray, atmosphere_.rain.top));
        if (height >= atmosphere_.ionosphere_base) return;
        const Angle there = elevation_at_height(ray, atmosphere_.ionosphere_base);
        arrival.iono_loss = ionosphere_absorption(atmosphere_, carrier, there);
    });
}

Decibels ionosphere_absorption(const AtmosphereParameters& atmosphere, Hertz carrier, Angle elevation_there) {
    Decibels loss = atmosphere.ionosphere_loss;
    if (atmosphere.riometer_absorption_30mhz.value() == 0) return loss;
    const double ratio = 30e6 / carrier.value();
    loss += atmosphere.riometer_absorption_30mhz * (ratio * ratio / std::sin(elevation_there.rad()));
    return loss;
}

namespace {

// Attenuation at another carrier over that at L1, of the air that the equivalent heights are for.
struct OverL1 {
    double oxygen = 1, vapour = 1;
};

OverL1 gas_over_l1(Hertz carrier) {
    const ReferenceAir air = reference_atmosphere_p835(Metres(0));
    const GasAttenuation here = gas_attenuation_p676(air, carrier);
    const GasAttenuation l1 = gas_attenuation_p676(air, Hertz(carrier_frequency_l1));
    return {here.oxygen.value() / l1.oxygen.value(), here.vapour.value() / l1.vapour.value()};
}

Decibels whole_zenith_loss(const WholePathParameters& p, Hertz carrier) {
    const OverL1 over = gas_over_l1(carrier);
    return Decibels(over.oxygen * p.oxygen_db_per_km * p.oxygen_height_km +
                    over.vapour * p.vapour_db_per_km_per_g_m3 * p.vapour_g_m3 * p.vapour_height_km);
}

Decibels at_slant(Decibels zenith, Angle elevation) { return zenith / std::sin(above_horizon(elevation).rad()); }

}  // namespace

Decibels whole_path_loss(const WholePathParameters& parameters, Angle elevation, Hertz carrier) {
    return at_slant(whole_zenith_loss(parameters, carrier), elevation);
}

void WholePathLoss::apply(Arrivals& arrivals, const SkyView& sky, const TruthState& /*truth*/) {
    for_each_arrival(arrivals, sky, [&](Arrival& arrival, const SatelliteInView& satellite) {
        const Decibels zenith =
            zenith_.of(first_carrier(arrival), [&](Hertz carrier) { return whole_zenith_loss(parameters_, carrier); });
        arrival.gas_loss = at_slant(zenith, satellite.elevation);
    });
}

DecibelWatts received_power(const Arrival& arrival, const LinkBudgetParameters& link) {
    const double unobstructed = link.power_mode == PowerMode::eirp
                                    ? link.satellite_power.value() - arrival.free_space_loss.value()
                                    : link.specified_received_power.value();
    const Decibels losses =
        arrival.gas_loss + arrival.iono_loss + arrival.cloud_loss + arrival.rain_loss + arrival.reflection_loss;
    return DecibelWatts(unobstructed - losses.value());
}

LinkBudget::LinkBudget(const LinkBudgetParameters& link, Decibels environment_noise)
    : link_(link), environment_noise_(environment_noise) {}

double LinkBudget::noise_density_dbw_hz() const { return link_.thermal_noise_dbw_hz + environment_noise_.value(); }

void LinkBudget::apply(Arrivals& arrivals, const SkyView& /*sky*/, const TruthState& /*truth*/) {
    for (Arrival& arrival : arrivals.satellites) {
        if (arrival.reflections > link_.max_reflections) hide(arrival);
        arrival.reflection_loss = link_.reflection_loss * arrival.reflections;
        arrival.received_power.reset();
        arrival.cn0.reset();
        if (arrival.paths == 0) continue;
        arrival.received_power = received_power(arrival, link_);
        arrival.cn0 = DbHz(arrival.received_power->value() - noise_density_dbw_hz());
    }
}

}  // namespace skyloop::inline world
