#include "receiver/error_model/simple_models.hpp"

#include <algorithm>
#include <cmath>

#include "base/geo/local_frame.hpp"
#include "receiver/error_model/baseline.hpp"

namespace skyloop::inline receiver {
namespace {

// Below it a horizontal velocity is what the turn from ECEF to the horizon has left of a vertical one.
constexpr MetresPerSecond rest{1e-6};

}  // namespace

Fix Ideal::fix(const TruthState& truth, const SkyView& sky, const Arrivals& arrivals) {
    Fix fix = builder_.start(truth, sky, arrivals);
    if (!fix.has_position()) return fix;
    builder_.place(fix, truth.position, Metres(0));
    fix.position = truth.geodetic;
    const Eigen::Vector3d enu = LocalFrame(truth.geodetic).to_enu(truth.velocity).vector();
    const GroundMotion motion = ground_motion({enu.y(), enu.x(), -enu.z()});
    fix.velocity = motion.velocity;
    fix.speed = motion.speed;
    if (motion.speed >= rest) course_ = motion.course;
    fix.course = course_;
    fix.speed_accuracy = MetresPerSecond(0);
    fix.course_accuracy = Angle();
    return fix;
}

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
    scale_.reset();
    Fix fix = builder_.start(truth, sky, arrivals);
    if (!fix.has_position()) return fix;
    const UereScale scale = uere_scale(fix, arrivals, residual_of_refraction(parameters_));
    scale_ = scale;
    const Metres per_axis = scale.position_error / std::sqrt(3.0);
    builder_.place(fix, truth.position + Displacement<Ecef>(per_axis.value() * normals), scale.position_error);
    fix.horizontal_accuracy = per_axis * std::sqrt(2.0);
    fix.vertical_accuracy = per_axis;
    return fix;
}

}  // namespace skyloop::inline receiver
