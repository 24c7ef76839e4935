/// The article's sensor model: DOP times the spread of the satellites' delays.
/// From the delays of satellites to the scale of the position error.
/// The sensor model with one attenuation for the whole path.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "receiver/error_model/error_model.hpp"
#include "receiver/error_model/fix_builder.hpp"
#include "receiver/error_model/model_parameters.hpp"
#include "world/flow/arrivals.hpp"
#include "world/flow/error_scale.hpp"
#include "world/flow/fix.hpp"

namespace skyloop::inline receiver {

/// User equivalent range error of one satellite: the fractions of its delays that are left uncorrected, and the whole
/// detour of a reflected path (MODELS.md 3.9 and D-09).
Metres user_equivalent_range_error(const Arrival& arrival, const BaselineParameters& parameters);

/// Spread over satellites: sample standard deviation (n − 1), or root mean square. 0 for fewer than two values or none.
Metres uere_spread(std::span<const Metres> errors, UereStatistic statistic);

/// σ_uere over the used satellites of `fix`, and E with its PDOP (MODELS.md 3.9).
/// @param fix its satellites are those of `arrivals`, in the same order
UereScale uere_scale(const Fix& fix, const Arrivals& arrivals, const BaselineParameters& parameters);

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
    [[nodiscard]] std::optional<UereScale> last_scale() const override { return scale_; }

private:
    void tell_accuracy(Fix& fix, const UereScale& scale) const;
    [[nodiscard]] Displacement<Ecef> position_error(const Fix& fix, const Geodetic& place, const UereScale& scale,
                                                    const Eigen::Vector3d& normals) const;

    BaselineParameters parameters_;
    FixBuilder builder_;
    PositionNoise noise_;
    std::optional<UereScale> scale_;
};

/// The article's model with WholePathLoss in the place of the layered atmosphere (MODELS.md section 6). The difference
/// lies in what arrives, so the fix is made like the baseline's, from a random stream of its own.
class WholePath : public Baseline {
public:
    WholePath(const BaselineParameters& parameters, const SensorContext& context)
        : Baseline(parameters, context, "whole-path.position") {}
};

}  // namespace skyloop::inline receiver
