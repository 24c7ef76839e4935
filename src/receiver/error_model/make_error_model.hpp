/// A sensor model by its name.
#pragma once

#include <memory>

#include "receiver/error_model/error_model.hpp"
#include "receiver/error_model/model_kind.hpp"
#include "receiver/error_model/sensor_context.hpp"

namespace skyloop {

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

}  // namespace skyloop
