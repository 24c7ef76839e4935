#include "receiver/error_model/constant_sigma.hpp"

#include <cmath>

#include "base/geo/local_frame.hpp"

namespace skyloop {

Fix ConstantSigma::fix(const TruthState& truth, const SkyView& sky, const Arrivals& arrivals) {
    const Eigen::Vector3d normals = noise_.draw();
    Fix fix = builder_.start(truth, sky, arrivals);
    if (!fix.has_position()) return fix;
    const double per_axis = parameters_.horizontal_sigma.value() / std::sqrt(2.0);
    const Eigen::Vector3d sigmas(per_axis, per_axis, parameters_.vertical_sigma.value());
    const Displacement<Enu> error(sigmas.cwiseProduct(normals));
    builder_.place(fix, truth.position + LocalFrame(truth.geodetic).to_ecef(error), Metres(sigmas.norm()));
    fix.horizontal_accuracy = parameters_.horizontal_sigma;
    fix.vertical_accuracy = parameters_.vertical_sigma;
    return fix;
}

}  // namespace skyloop
