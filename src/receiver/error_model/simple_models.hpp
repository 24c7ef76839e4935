/// A receiver without errors.
/// The sensor model with one constant spread.
/// The sensor model whose spread depends on how many satellites are used.
/// The sensor model whose only error is what refraction leaves.
#pragma once

#include "receiver/error_model/error_model.hpp"
#include "receiver/error_model/fix_builder.hpp"

namespace skyloop::inline receiver {

/// The fix is the truth, velocity included, with every healthy satellite above the mask, hidden or not (MODELS.md
/// section 6). Its accuracies are 0. At rest its course is the last one.
///
/// State: that course.
class Ideal : public ErrorModel {
public:
    explicit Ideal(const SensorContext& context) : builder_(context, {.hidden_too = true}) {}
    Fix fix(const TruthState& truth, const SkyView& sky, const Arrivals& arrivals) override;

private:
    FixBuilder builder_;
    Angle course_;
};

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

/// Adds noise of scale PDOP·σ, σ being the root mean square over the used satellites of what remains of their excess
/// paths (MODELS.md section 6). Needs RefractionDelay, which writes the excess paths as tropospheric delays.
///
/// Variance is equal on the axes of ECEF, and so are the reported accuracies: E·√(2/3) and E/√3 of E = PDOP·σ.
class Refraction : public ErrorModel {
public:
    Refraction(const RefractionParameters& parameters, const SensorContext& context)
        : parameters_(parameters), builder_(context, {}), noise_(context.seed, "refraction.position") {}
    Fix fix(const TruthState& truth, const SkyView& sky, const Arrivals& arrivals) override;
    [[nodiscard]] std::optional<UereScale> last_scale() const override { return scale_; }

private:
    RefractionParameters parameters_;
    FixBuilder builder_;
    PositionNoise noise_;
    std::optional<UereScale> scale_;
};

}  // namespace skyloop::inline receiver
