#include "receiver/error_model/refraction.hpp"

#include <cmath>

#include "receiver/error_model/uere.hpp"

namespace skyloop {
namespace {

// The article's error scale with the residual of the excess path as the only cause.
BaselineParameters residual_of_refraction(const RefractionParameters& parameters) {
    BaselineParameters scale;
    scale.statistic = UereStatistic::rms;
    scale.iono_fraction = 0;
    scale.tropo_fraction = parameters.residual_fraction;
    return scale;
}

}  // namespace

Fix Refraction::fix(const TruthState& truth, const SkyView& sky, const Arrivals& arrivals) {
    const Eigen::Vector3d normals = noise_.draw();
    Fix fix = builder_.start(truth, sky, arrivals);
    if (!fix.has_position()) return fix;
    const UereScale scale = uere_scale(fix, arrivals, residual_of_refraction(parameters_));
    const Metres per_axis = scale.position_error / std::sqrt(3.0);
    builder_.place(fix, truth.position + Displacement<Ecef>(per_axis.value() * normals), scale.position_error);
    fix.horizontal_accuracy = per_axis * std::sqrt(2.0);
    fix.vertical_accuracy = per_axis;
    return fix;
}

}  // namespace skyloop
