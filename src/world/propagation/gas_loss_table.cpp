#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "detail/sea_level.hpp"
#include "world/propagation/atmosphere_losses.hpp"
#include "world/propagation/gas_attenuation_p676.hpp"
#include "world/propagation/refraction_delay.hpp"

namespace skyloop {
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
    assert(arrivals.satellites.size() == sky.satellites.size());
    if (factor_ == 0) return;
    const MslHeight height = sea_level_height(truth.geodetic, geoid_);
    for (std::size_t i = 0; i < sky.satellites.size(); ++i) {
        const Angle apparent = apparent_elevation(sky.satellites[i].elevation, height);
        arrivals.satellites[i].gas_loss = table_->loss(apparent, height.above_sea_level) * factor_;
    }
}

}  // namespace skyloop
