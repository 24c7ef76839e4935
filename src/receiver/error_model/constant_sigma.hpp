/// The sensor model with one constant spread.
#pragma once

#include "receiver/error_model/error_model.hpp"
#include "receiver/error_model/fix_builder.hpp"
#include "receiver/error_model/position_noise.hpp"

namespace skyloop {

/// Adds normal noise of variances σ_H²/2, σ_H²/2, σ_V² east, north and up (MODELS.md section 6). Reported accuracies
/// are σ_H and σ_V.
class ConstantSigma : public ErrorModel {
public:
    ConstantSigma(const ConstantSigmaParameters& parameters, const SensorContext& context)
        : parameters_(parameters), builder_(context, {}), noise_(context.seed, "constant-sigma.position") {}
    Fix fix(const TruthState& truth, const SkyView& sky, const Arrivals& arrivals) override;

private:
    ConstantSigmaParameters parameters_;
    FixBuilder builder_;
    PositionNoise noise_;
};

}  // namespace skyloop
