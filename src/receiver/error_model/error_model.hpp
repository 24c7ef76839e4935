/// The seam of all sensor models that add errors to the truth instead of measuring and solving.
/// What a sensor model knows besides its own parameters.
/// A sensor model by its name.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "base/geo/geoid.hpp"
#include "base/time/utc_time.hpp"
#include "receiver/error_model/model_parameters.hpp"
#include "world/flow/arrivals.hpp"
#include "world/flow/error_scale.hpp"
#include "world/flow/fix.hpp"
#include "world/flow/sky_view.hpp"
#include "world/flow/truth_state.hpp"

namespace skyloop::inline receiver {

/// A sensor model of the literature: from what is true and what arrives to what the receiver reports.
class ErrorModel {
public:
    virtual ~ErrorModel() = default;
    /// The fix of one epoch; epochs come in ascending time. Its satellites are those of `sky`, in its order.
    virtual Fix fix(const TruthState& truth, const SkyView& sky, const Arrivals& arrivals) = 0;
    /// What the error of the last fix was drawn from; nothing without a fix, and of models with errors of other causes.
    [[nodiscard]] virtual std::optional<UereScale> last_scale() const { return std::nullopt; }
};

/// Shared by all sensor models of a run.
struct SensorContext {
    SelectionParameters selection;
    std::uint64_t seed = 1;
    const Geoid* geoid = nullptr;  ///< of the receiver; must outlive the model; without one the undulation is 0
    LeapSeconds leap_seconds = LeapSeconds::announced();
    double geoid_step_deg = 0;  ///< Geoid::undulation()
};

/// Which model, and the parameters of each: only those of `kind` are read.
struct ErrorModelSettings {
    ErrorModelKind kind = ErrorModelKind::baseline;
    SensorContext sensor;
    BaselineParameters baseline;  ///< of whole-path too
    ConstantSigmaParameters constant_sigma;
    SatelliteCountParameters satellite_count;
    RefractionParameters refraction;
};

/// The model alone. What must arrive for it is made by the effects of effects_for().
std::unique_ptr<ErrorModel> make_error_model(const ErrorModelSettings& settings);

}  // namespace skyloop::inline receiver
