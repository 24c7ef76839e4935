/// What must happen to the signals for each sensor model.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/core/result.hpp"
#include "base/geo/geoid.hpp"
#include "base/time/utc_time.hpp"
#include "receiver/error_model/model_parameters.hpp"
#include "world/gnss/ephemeris.hpp"
#include "world/propagation/named_ionosphere_maps.hpp"
#include "world/propagation/propagation_effect.hpp"
#include "world/propagation/propagation_parameters.hpp"

namespace skyloop::inline receiver {

/// The numbers of all effects; those that the model does not need are not read.
struct EffectSettings {
    AtmosphereParameters atmosphere;
    LinkBudgetParameters link_budget;
    WholePathParameters whole_path;
    RefractionParameters refraction;
    std::optional<KlobucharCoefficients> klobuchar;  ///< of the navigation data
    std::optional<NamedIonosphereMaps> maps{};       ///< for the source `ionex`
    TimeSpan run{};                                  ///< first and last instant of the run, which they must span
    const Geoid* geoid = nullptr;                    ///< must outlive the effects; without one heights stay ellipsoidal
    LeapSeconds leap_seconds = LeapSeconds::announced();
    std::string tec_source_told_at = "atmosphere.tec_source: ";  ///< "FILE:LINE:COLUMN: KEY: ", for messages
};

/// Whether a model's ionosphere is that of the electron content of the atmosphere's settings: baseline and whole-path.
bool takes_electron_content(ErrorModelKind kind);

/// The effects of a model in the order of their application; the link budget is the last, and effects of the scene go
/// before it.
///
///     ideal, constant-sigma, satellite-count   link budget in free space
///     refraction                               excess path of the bent ray, link budget
///     whole-path                               one attenuation, TEC and Niell delays, link budget
///     baseline                                 layered attenuation, TEC and Niell delays, link budget
///
/// Fails with `input` when the electron content is to come from navigation data that has no coefficients, or from maps
/// that are not there or that do not cover the run and the globe.
Result<std::vector<std::unique_ptr<PropagationEffect>>> effects_for(ErrorModelKind kind,
                                                                    const EffectSettings& settings);

}  // namespace skyloop::inline receiver
