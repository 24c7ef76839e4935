#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "sea_level.hpp"
#include "skyloop/propagation/atmosphere_losses.hpp"
#include "skyloop/propagation/gas_attenuation_p676.hpp"

namespace skyloop {
namespace {

constexpr std::array<double, 20> gas_elevations_deg{0.5, 0.75, 1,  1.25, 1.5, 2,  2.5, 3,  4,  5,
                                                    6,   8,    10, 13,   17,  23, 32,  45, 65, 90};
constexpr double gas_height_step_km = 1;
constexpr std::size_t gas_heights = 21;

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

// Elevation on a scale on which slant factors are nearly straight lines: the level path through a thin atmosphere.
double gas_abscissa(double elevation_deg) { return std::log(std::sin(Angle::degrees(elevation_deg).rad()) + 0.04); }

}  // namespace

GasLossTable::GasLossTable(Hertz carrier) {
    for (std::size_t row = 0; row < gas_heights; ++row) {
        const Metres height(1000 * gas_height_step_km * static_cast<double>(row));
        const double zenith = slant_gas_attenuation_p676(carrier, Angle::degrees(90), height).value();
        zeniths_.push_back(std::log(zenith));
        for (const double elevation : gas_elevations_deg) {
            const double slant = slant_gas_attenuation_p676(carrier, Angle::degrees(elevation), height).value();
            slants_.push_back(std::log(slant / zenith));
        }
    }
}

Decibels GasLossTable::loss(Angle elevation, Metres antenna_height) const {
    const double degrees = std::clamp(elevation.deg(), gas_elevations_deg.front(), gas_elevations_deg.back());
    const auto above = std::upper_bound(gas_elevations_deg.begin(), gas_elevations_deg.end(), degrees);
    const auto column = static_cast<std::size_t>(std::max<std::ptrdiff_t>(above - gas_elevations_deg.begin() - 1, 0));
    const CubicStencil across = cubic_stencil(gas_abscissa(degrees), gas_elevations_deg.size(), column,
                                              [](std::size_t i) { return gas_abscissa(gas_elevations_deg[i]); });
    const double height = std::clamp(antenna_height.value() / 1000, 0.0, gas_height_step_km * (gas_heights - 1));
    const CubicStencil up = cubic_stencil(height, gas_heights, static_cast<std::size_t>(height / gas_height_step_km),
                                          [](std::size_t i) { return gas_height_step_km * static_cast<double>(i); });
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t row = up.first + i;
        double slant = 0;
        for (std::size_t j = 0; j < 4; ++j)
            slant += across.weight[j] * slants_[row * gas_elevations_deg.size() + across.first + j];
        sum += up.weight[i] * (zeniths_[row] + slant);
    }
    return Decibels(std::exp(sum));
}

void GasLoss::apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) {
    assert(arrivals.satellites.size() == sky.satellites.size());
    if (factor_ == 0) return;
    const Metres height = sea_level_height(truth.geodetic, geoid_).above_sea_level;
    for (std::size_t i = 0; i < sky.satellites.size(); ++i)
        arrivals.satellites[i].gas_loss = table_.loss(sky.satellites[i].elevation, height) * factor_;
}

}  // namespace skyloop
