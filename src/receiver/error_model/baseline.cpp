#include "receiver/error_model/baseline.hpp"

#include <Eigen/Cholesky>

#include <cassert>
#include <cmath>

#include "base/geo/local_frame.hpp"

namespace skyloop::inline receiver {

Metres user_equivalent_range_error(const Arrival& arrival, const BaselineParameters& parameters) {
    return parameters.iono_fraction * arrival.iono_delay + parameters.tropo_fraction * arrival.tropo_delay +
           arrival.excess_path;
}

Metres uere_spread(std::span<const Metres> errors, UereStatistic statistic) {
    const auto n = static_cast<double>(errors.size());
    double centre = 0;
    double freedom = n;
    if (statistic == UereStatistic::sample_std) {
        for (const Metres error : errors)
            centre += error.value();
        centre /= n;
        freedom = n - 1;
    }
    if (freedom < 1) return Metres(0);
    double squares = 0;
    for (const Metres error : errors)
        squares += (error.value() - centre) * (error.value() - centre);
    return Metres(std::sqrt(squares / freedom));
}

UereScale uere_scale(const Fix& fix, const Arrivals& arrivals, const BaselineParameters& parameters) {
    assert(fix.satellites.size() == arrivals.satellites.size());
    std::vector<Metres> errors;
    for (std::size_t i = 0; i < fix.satellites.size(); ++i)
        if (fix.satellites[i].used) errors.push_back(user_equivalent_range_error(arrivals.satellites[i], parameters));
    const Metres sigma = uere_spread(errors, parameters.statistic);
    return {sigma, fix.dop.pdop * sigma};
}

namespace {

// Normal numbers of covariance σ²Q in the local frame (MODELS.md D-10, `covariance`).
Displacement<Enu> correlated_noise(const Eigen::Matrix4d& cofactors, Metres sigma, const Eigen::Vector3d& normals) {
    const Eigen::Matrix3d root = cofactors.topLeftCorner<3, 3>().llt().matrixL();
    return Displacement<Enu>(sigma.value() * (root * normals));
}

}  // namespace

Baseline::Baseline(const BaselineParameters& parameters, const SensorContext& context, std::string_view stream)
    : parameters_(parameters), builder_(context, {.snr_cutoff = parameters.snr_cutoff}), noise_(context.seed, stream) {}

Fix Baseline::fix(const TruthState& truth, const SkyView& sky, const Arrivals& arrivals) {
    const Eigen::Vector3d normals = noise_.draw();
    scale_.reset();
    Fix fix = builder_.start(truth, sky, arrivals);
    if (!fix.has_position()) return fix;
    const UereScale scale = uere_scale(fix, arrivals, parameters_);
    scale_ = scale;
    tell_accuracy(fix, scale);
    const Displacement<Ecef> error = position_error(fix, truth.geodetic, scale, normals);
    builder_.place(fix, truth.position + error, scale.position_error);
    return fix;
}

// Of the noise that is drawn, whose axes know the geometry or do not.
void Baseline::tell_accuracy(Fix& fix, const UereScale& scale) const {
    const bool covariance = parameters_.axes == NoiseAxes::covariance;
    const Metres per_axis = scale.position_error / std::sqrt(3.0);
    fix.horizontal_accuracy = covariance ? fix.dop.hdop * scale.sigma_uere : per_axis * std::sqrt(2.0);
    fix.vertical_accuracy = covariance ? fix.dop.vdop * scale.sigma_uere : per_axis;
}

Displacement<Ecef> Baseline::position_error(const Fix& fix, const Geodetic& place, const UereScale& scale,
                                            const Eigen::Vector3d& normals) const {
    if (parameters_.axes == NoiseAxes::covariance) {
        if (const auto cofactors = cofactor_matrix(used_directions(fix.satellites)))
            return LocalFrame(place).to_ecef(correlated_noise(*cofactors, scale.sigma_uere, normals));
    }
    return Displacement<Ecef>(scale.position_error.value() / std::sqrt(3.0) * normals);
}

}  // namespace skyloop::inline receiver
