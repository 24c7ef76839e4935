#include "receiver/error_model/satellite_count.hpp"

#include <algorithm>
#include <cmath>

namespace skyloop {

Metres sigma_for_count(const SatelliteCountParameters& parameters, int satellites_used) {
    const auto last = static_cast<int>(parameters.sigma_m.size()) - 1;
    return Metres(parameters.sigma_m.at(static_cast<std::size_t>(std::clamp(satellites_used - 4, 0, last))));
}

Fix SatelliteCount::fix(const TruthState& truth, const SkyView& sky, const Arrivals& arrivals) {
    const Eigen::Vector3d normals = noise_.draw();
    Fix fix = builder_.start(truth, sky, arrivals);
    if (!fix.has_position()) return fix;
    const Metres sigma = sigma_for_count(parameters_, fix.satellites_used());
    builder_.place(fix, truth.position + Displacement<Ecef>(sigma.value() * normals), sigma * std::sqrt(3.0));
    fix.horizontal_accuracy = sigma * std::sqrt(2.0);
    fix.vertical_accuracy = sigma;
    return fix;
}

}  // namespace skyloop
