#include "world/propagation/atmosphere_losses.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "detail/sea_level.hpp"
#include "world/propagation/cloud_attenuation_p840.hpp"
#include "world/propagation/reference_atmosphere_p835.hpp"
#include "world/propagation/spherical_path.hpp"

namespace skyloop {
namespace {

constexpr double freezing_point = 273.15;  // K

// A straight ray over a sphere whose surface is the sea.
SphericalRay ray_over_sea(const SatelliteInView& satellite, Metres antenna_height) {
    return {satellite.elevation, antenna_height};
}

}  // namespace

CloudLoss::CloudLoss(const std::vector<CloudDeck>& decks, const ErrorTerm& term, const Geoid* geoid)
    : factor_(term.factor()), geoid_(geoid) {
    for (const CloudDeck& deck : decks) {
        const ReferenceAir air = reference_atmosphere_p835((deck.base + deck.top) / 2);
        const Kelvin temperature = std::max(air.temperature, Kelvin(freezing_point));
        decks_.push_back(
            {deck.base, deck.top, cloud_attenuation_p840(Hertz(carrier_frequency_l1), temperature, deck.density_g_m3)});
    }
}

void CloudLoss::apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) {
    assert(arrivals.satellites.size() == sky.satellites.size());
    if (factor_ == 0 || decks_.empty()) return;
    const Metres height = sea_level_height(truth.geodetic, geoid_).above_sea_level;
    for (std::size_t i = 0; i < sky.satellites.size(); ++i) {
        Decibels loss;
        for (const Deck& deck : decks_) {
            if (deck.top <= height) continue;
            loss +=
                loss_over(deck.attenuation, shell_path(ray_over_sea(sky.satellites[i], height), deck.base, deck.top));
        }
        arrivals.satellites[i].cloud_loss = loss * factor_;
    }
}

void RainLoss::apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) {
    assert(arrivals.satellites.size() == sky.satellites.size());
    if (factor_ == 0 || rain_.rate_mm_h <= 0) return;
    const Metres height = sea_level_height(truth.geodetic, geoid_).above_sea_level;
    if (height >= rain_.top) return;
    for (std::size_t i = 0; i < sky.satellites.size(); ++i) {
        const SphericalRay ray = ray_over_sea(sky.satellites[i], height);
        const double level = std::cos(ray.elevation.rad());
        Metres path = path_to_height(ray, rain_.top);
        if (path.value() * level > cell_.value()) path = cell_ / level;
        const auto attenuation = rain_attenuation(rain_, Hertz(carrier_frequency_l1), ray.elevation);
        arrivals.satellites[i].rain_loss = loss_over(attenuation, path) * factor_;
    }
}

void FoliageLoss::apply(Arrivals& arrivals, const SkyView& sky, const TruthState& /*truth*/) {
    assert(arrivals.satellites.size() == sky.satellites.size());
    if (factor_ == 0 || parameters_.canopy_depth.value() <= 0) return;
    for (std::size_t i = 0; i < sky.satellites.size(); ++i) {
        const Angle elevation = sky.satellites[i].elevation;
        if (elevation > parameters_.canopy_top) continue;
        const double metres = parameters_.canopy_depth.value() * parameters_.canopy_density / std::cos(elevation.rad());
        const Decibels loss(parameters_.canopy_db_per_m * metres);
        arrivals.satellites[i].foliage_loss = std::min(loss, parameters_.most_foliage) * factor_;
    }
}

}  // namespace skyloop
