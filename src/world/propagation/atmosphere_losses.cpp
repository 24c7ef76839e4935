#include "world/propagation/atmosphere_losses.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "world/propagation/gas_attenuation_p676.hpp"
#include "world/propagation/ray_geometry.hpp"
#include "world/propagation/reference_air.hpp"
#include "world/propagation/sensor_model_delays.hpp"
#include "world/propagation/specific_attenuation.hpp"

namespace skyloop::inline world {
namespace {

constexpr std::array<double, 20> gas_elevations_deg{0.5, 0.75, 1,  1.25, 1.5, 2,  2.5, 3,  4,  5,
                                                    6,   8,    10, 13,   17,  23, 32,  45, 65, 90};
// So short that a cubic follows the bend of the temperature at the tropopause.
constexpr double gas_height_step_km = 0.5;

// Place between the entries of an ascending table: lower index of four neighbours, and their Lagrange weights.
struct CubicStencil {
    std::size_t first = 0;
    std::array<double, 4> weight{};
};

template <class Node>
CubicStencil cubic_stencil(double x, std::size_t count, std::size_t below, Node&& node) {
    CubicStencil stencil;
    stencil.first = std::min(below > 0 ? below - 1 : 0, count - 4);
    for (std::size_t i = 0; i < 4; ++i) {
        stencil.weight[i] = 1;
        for (std::size_t j = 0; j < 4; ++j) {
            if (i == j) continue;
            const double xi = node(stencil.first + i), xj = node(stencil.first + j);
            stencil.weight[i] *= (x - xj) / (xi - xj);
        }
    }
    return stencil;
}

// Where the bent ray of a satellite arrives. The fit has a pole at −4.7°: below the horizon its bend holds.
Angle apparent_elevation(Angle free_space_elevation, MslHeight antenna) {
    return free_space_elevation + refraction_bending(std::max(free_space_elevation, Angle()), antenna);
}

// Elevation on a scale on which slant factors are nearly straight lines: the level path through a thin atmosphere.
double gas_abscissa(double elevation_deg) { return std::log(std::sin(Angle::degrees(elevation_deg).rad()) + 0.04); }

}  // namespace

GasLossTable::GasLossTable(Hertz carrier) : carrier_(carrier) {
    for (const double elevation : gas_elevations_deg)
        abscissae_.push_back(gas_abscissa(elevation));
}

const std::vector<double>& GasLossTable::row(std::size_t index) {
    std::vector<double>& row = rows_[index];
    if (!row.empty()) return row;
    std::array<Angle, gas_elevations_deg.size()> elevations;
    for (std::size_t i = 0; i < elevations.size(); ++i)
        elevations[i] = Angle::degrees(gas_elevations_deg[i]);
    const Metres height(1000 * gas_height_step_km * static_cast<double>(index));
    for (const Decibels loss : slant_gas_attenuation_p676(carrier_, elevations, height))
        row.push_back(std::log(loss.value()));
    return row;
}

Decibels GasLossTable::loss(Angle elevation, Metres antenna_height) {
    const double degrees = std::clamp(elevation.deg(), gas_elevations_deg.front(), gas_elevations_deg.back());
    const auto above = std::upper_bound(gas_elevations_deg.begin(), gas_elevations_deg.end(), degrees);
    const auto column = static_cast<std::size_t>(std::max<std::ptrdiff_t>(above - gas_elevations_deg.begin() - 1, 0));
    const CubicStencil across = cubic_stencil(gas_abscissa(degrees), gas_elevations_deg.size(), column,
                                              [this](std::size_t i) { return abscissae_[i]; });
    const double height = std::clamp(antenna_height.value() / 1000, 0.0, gas_height_step_km * (heights - 1));
    const CubicStencil up = cubic_stencil(height, heights, static_cast<std::size_t>(height / gas_height_step_km),
                                          [](std::size_t i) { return gas_height_step_km * static_cast<double>(i); });
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        const std::vector<double>& logarithms = row(up.first + i);
        for (std::size_t j = 0; j < 4; ++j)
            sum += up.weight[i] * across.weight[j] * logarithms[across.first + j];
    }
    return Decibels(std::exp(sum));
}

void GasLoss::apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) {
    if (factor_ == 0) return;
    const MslHeight height = sea_level_height(truth.geodetic, geoid_);
    for_each_arrival(arrivals, sky, [&](Arrival& arrival, const SatelliteInView& satellite) {
        const Angle apparent = apparent_elevation(satellite.elevation, height);
        arrival.gas_loss = table_->loss(apparent, height.above_sea_level) * factor_;
    });
}

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
    if (factor_ == 0 || decks_.empty()) return;
    const Metres height = sea_level_height(truth.geodetic, geoid_).above_sea_level;
    for_each_arrival(arrivals, sky, [&](Arrival& arrival, const SatelliteInView& satellite) {
        const SphericalRay ray = ray_over_sea(satellite, height);
        Decibels loss;
        for (const Deck& deck : decks_)
            if (deck.top > height) loss += loss_over(deck.attenuation, shell_path(ray, deck.base, deck.top));
        arrival.cloud_loss = loss * factor_;
    });
}

void RainLoss::apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) {
    if (factor_ == 0 || rain_.rate_mm_h <= 0) return;
    const Metres height = sea_level_height(truth.geodetic, geoid_).above_sea_level;
    if (height >= rain_.top) return;
    for_each_arrival(arrivals, sky, [&](Arrival& arrival, const SatelliteInView& satellite) {
        const SphericalRay ray = ray_over_sea(satellite, height);
        const double level = std::cos(ray.elevation.rad());
        Metres path = path_to_height(ray, rain_.top);
        if (path.value() * level > cell_.value()) path = cell_ / level;
        const auto attenuation = rain_attenuation(rain_, Hertz(carrier_frequency_l1), ray.elevation);
        arrival.rain_loss = loss_over(attenuation, path) * factor_;
    });
}

void FoliageLoss::apply(Arrivals& arrivals, const SkyView& sky, const TruthState& /*truth*/) {
    if (factor_ == 0 || parameters_.canopy_depth.value() <= 0) return;
    for_each_arrival(arrivals, sky, [&](Arrival& arrival, const SatelliteInView& satellite) {
        const Angle elevation = satellite.elevation;
        if (elevation > parameters_.canopy_top) return;
        const double metres = parameters_.canopy_depth.value() * parameters_.canopy_density / std::cos(elevation.rad());
        const Decibels loss(parameters_.canopy_db_per_m * metres);
        arrival.foliage_loss = std::min(loss, parameters_.most_foliage) * factor_;
    });
}

}  // namespace skyloop::inline world
