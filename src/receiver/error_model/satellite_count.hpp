/// The sensor model whose spread depends on how many satellites are used.
#pragma once

#include "receiver/error_model/error_model.hpp"
#include "receiver/error_model/fix_builder.hpp"
#include "receiver/error_model/position_noise.hpp"

namespace skyloop {

/// Adds normal noise of the same σ on each axis, from a table by the number of used satellites (MODELS.md section 6).
/// Reported accuracies are √2·σ and σ.
class SatelliteCount : public ErrorModel {
public:
    SatelliteCount(const SatelliteCountParameters& parameters, const SensorContext& context)
        : parameters_(parameters), builder_(context, {}), noise_(context.seed, "satellite-count.position") {}
    Fix fix(const TruthState& truth, const SkyView& sky, const Arrivals& arrivals) override;

private:
    SatelliteCountParameters parameters_;
    FixBuilder builder_;
    PositionNoise noise_;
};

/// The table's σ for a number of used satellites, 4 or more.
Metres sigma_for_count(const SatelliteCountParameters& parameters, int satellites_used);

}  // namespace skyloop
