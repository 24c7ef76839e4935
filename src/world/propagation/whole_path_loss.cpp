#include "world/propagation/whole_path_loss.hpp"

#include <cassert>
#include <cmath>

#include "detail/lowest_elevation.hpp"

namespace skyloop {

Decibels whole_path_loss(const WholePathParameters& p, Angle elevation) {
    const double zenith =
        p.oxygen_db_per_km * p.oxygen_height_km + p.vapour_db_per_km_per_g_m3 * p.vapour_g_m3 * p.vapour_height_km;
    return Decibels(zenith / std::sin(above_horizon(elevation).rad()));
}

void WholePathLoss::apply(Arrivals& arrivals, const SkyView& sky, const TruthState& /*truth*/) {
    assert(arrivals.satellites.size() == sky.satellites.size());
    for (std::size_t i = 0; i < sky.satellites.size(); ++i)
        arrivals.satellites[i].gas_loss = whole_path_loss(parameters_, sky.satellites[i].elevation);
}

}  // namespace skyloop
