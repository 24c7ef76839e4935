/// The article's sensor model: DOP times the spread of the satellites' delays.
#pragma once

#include <string_view>

#include "receiver/error_model/error_model.hpp"
#include "receiver/error_model/fix_builder.hpp"
#include "receiver/error_model/position_noise.hpp"
#include "receiver/error_model/uere.hpp"

namespace skyloop {

/// Adds noise of scale E = PDOP·σ_uere to the true position, in ECEF, white from epoch to epoch; velocity and course
/// follow from the noised positions (MODELS.md 3.5–3.10, D-08 … D-11).
///
/// Reported accuracies are those of the noise: E·√(2/3) and E/√3, with axes by covariance HDOP·σ_uere and VDOP·σ_uere.
class Baseline : public ErrorModel {
public:
    /// @param stream name of the random stream
    Baseline(const BaselineParameters& parameters, const SensorContext& context,
             std::string_view stream = "baseline.position");
    Fix fix(const TruthState& truth, const SkyView& sky, const Arrivals& arrivals) override;

private:
    void tell_accuracy(Fix& fix, const UereScale& scale) const;
    [[nodiscard]] Displacement<Ecef> position_error(const Fix& fix, const Geodetic& place, const UereScale& scale,
                                                    const Eigen::Vector3d& normals) const;

    BaselineParameters parameters_;
    FixBuilder builder_;
    PositionNoise noise_;
};

}  // namespace skyloop
