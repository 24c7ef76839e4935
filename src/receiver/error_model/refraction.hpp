/// The sensor model whose only error is what refraction leaves.
#pragma once

#include "receiver/error_model/error_model.hpp"
#include "receiver/error_model/fix_builder.hpp"
#include "receiver/error_model/position_noise.hpp"

namespace skyloop {

/// Adds noise of scale PDOP·σ, σ being the root mean square over the used satellites of what remains of their excess
/// paths (MODELS.md section 6). Needs RefractionDelay, which writes the excess paths as tropospheric delays.
///
/// Variance is equal on the axes of ECEF, and so are the reported accuracies: E·√(2/3) and E/√3 of E = PDOP·σ.
class Refraction : public ErrorModel {
public:
    Refraction(const RefractionParameters& parameters, const SensorContext& context)
        : parameters_(parameters), builder_(context, {}), noise_(context.seed, "refraction.position") {}
    Fix fix(const TruthState& truth, const SkyView& sky, const Arrivals& arrivals) override;

private:
    RefractionParameters parameters_;
    FixBuilder builder_;
    PositionNoise noise_;
};

}  // namespace skyloop
