/// One gaseous attenuation for the whole path: the simplest model of the air.
#pragma once

#include "world/propagation/effect.hpp"
#include "world/propagation/whole_path_parameters.hpp"

namespace skyloop {

/// (γ_o h_o + γ_w h_w)/sin e (MODELS.md section 6, whole-path).
Decibels whole_path_loss(const WholePathParameters& parameters, Angle elevation);

/// Writes the gas loss of each arrival, at L1; clouds and rain have no part in this model.
class WholePathLoss : public PropagationEffect {
public:
    explicit WholePathLoss(const WholePathParameters& parameters) : parameters_(parameters) {}
    void apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) override;

private:
    WholePathParameters parameters_;
};

}  // namespace skyloop
