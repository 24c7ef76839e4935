/// The sensor model with one attenuation for the whole path.
#pragma once

#include "receiver/error_model/baseline.hpp"

namespace skyloop {

/// The article's model with WholePathLoss in the place of the layered atmosphere (MODELS.md section 6). The difference
/// lies in what arrives, so the fix is made like the baseline's, from a random stream of its own.
class WholePath : public ErrorModel {
public:
    WholePath(const BaselineParameters& parameters, const SensorContext& context)
        : baseline_(parameters, context, "whole-path.position") {}
    Fix fix(const TruthState& truth, const SkyView& sky, const Arrivals& arrivals) override {
        return baseline_.fix(truth, sky, arrivals);
    }

private:
    Baseline baseline_;
};

}  // namespace skyloop
