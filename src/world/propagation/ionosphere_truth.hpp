/// The true ionosphere, by one of several models.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "base/core/result.hpp"
#include "world/flow/sky_view.hpp"
#include "world/flow/truth_state.hpp"
#include "world/propagation/modern_effects.hpp"

namespace skyloop {

/// How much a model of the ionosphere delays the code of a satellite.
class IonosphereTruth {
public:
    virtual ~IonosphereTruth() = default;
    /// The delay along the ray; instants come in ascending order.
    virtual Metres delay(const SatelliteInView& satellite, const TruthState& truth, Hertz carrier) = 0;
};

/// The model that the parameters name: with the coefficients of the broadcast, or the parameters' own where the
/// broadcast has none. Over a thin shell (ionex, constant) a delay is mapped by single_layer_mapping(); above the shell
/// there is none. Past the last of its maps ionex holds that one, turned with the Sun. Fails as modern_effects() does.
Result<std::unique_ptr<IonosphereTruth>> make_ionosphere_truth(const IonosphereParameters& parameters,
                                                               const ModernContext& context);

/// NeQuick-G, each month by its own tables. It takes a millisecond or so a ray: each satellite's is traced for the
/// whole half minutes of GPS time alone, from where satellite and antenna then are, and the electron content is linear
/// in between. The satellite is carried ahead of the epoch by its velocity and the Earth's attraction, to within a
/// metre. Fails when the folder lacks a table, naming the month.
Result<std::unique_ptr<IonosphereTruth>> make_nequick_truth(const EffectiveIonisation& ionisation,
                                                            const ModernContext& context);

}  // namespace skyloop
