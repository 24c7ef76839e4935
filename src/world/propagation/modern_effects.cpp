#include "world/propagation/modern_effects.hpp"

#include <utility>

#include "world/propagation/atmosphere_losses.hpp"
#include "world/propagation/ionosphere_effects.hpp"
#include "world/propagation/modern_link_budget.hpp"
#include "world/propagation/precise_effects.hpp"
#include "world/propagation/signal_in_space_error.hpp"
#include "world/propagation/surroundings_effect.hpp"
#include "world/propagation/troposphere_delay.hpp"

namespace skyloop::inline world {
namespace {

bool residual_wanted(const IonosphereParameters& parameters, std::optional<IonosphereModel> correction) {
    if (parameters.residual != Choice::automatic) return parameters.residual == Choice::on;
    return !correction || *correction == parameters.model;
}

// What only counts beside orbits and clocks of centimetres.
void add_precise(std::vector<std::unique_ptr<PropagationEffect>>& effects,
                 const ModernPropagationParameters& parameters, const ModernContext& context) {
    if (!context.precise) return;
    if (context.precise->antennas())
        effects.push_back(
            std::make_unique<SatelliteAntennaPhase>(context.precise->antennas(), parameters.satellite_antenna));
    if (context.receiver_antenna)
        effects.push_back(
            std::make_unique<ReceiverAntennaPhase>(*context.receiver_antenna, parameters.receiver_antenna));
    effects.push_back(std::make_unique<CarrierWindUp>(parameters.wind_up));
    effects.push_back(std::make_unique<SolidTideEffect>(parameters.solid_tide));
}

}  // namespace

ResidualReach residual_reach(const IonosphereParameters& parameters, const ModernContext& context) {
    const auto galileo = context.galileo_correction ? context.galileo_correction : context.receiver_correction;
    return {residual_wanted(parameters, galileo), residual_wanted(parameters, context.receiver_correction)};
}

Result<std::vector<std::unique_ptr<PropagationEffect>>> modern_effects(const ModernPropagationParameters& parameters,
                                                                       const ModernContext& context) {
    auto truth = make_ionosphere_truth(parameters.ionosphere_model, context);
    if (!truth) return fail(truth.error());
    const AtmosphereParameters& air = context.atmosphere;
    const ResidualReach residual = residual_reach(parameters.ionosphere_model, context);
    const TroposphereDelay::Site site{context.geoid, context.leap_seconds};

    std::vector<std::unique_ptr<PropagationEffect>> effects;
    effects.push_back(std::make_unique<SignalInSpaceError>(parameters.signal_in_space_model, parameters.signal_in_space,
                                                           context.seed));
    add_precise(effects, parameters, context);
    effects.push_back(std::make_unique<IonosphereDelay>(std::move(*truth), parameters, residual, context.seed));
    effects.push_back(std::make_unique<TroposphereDelay>(parameters, air, site, context.seed));
    effects.push_back(std::make_unique<GasLoss>(parameters.gas, context.geoid, context.gas_losses));
    effects.push_back(std::make_unique<CloudLoss>(air.clouds, parameters.clouds, context.geoid));
    effects.push_back(std::make_unique<RainLoss>(air.rain, parameters, context.geoid));
    effects.push_back(std::make_unique<FoliageLoss>(parameters.loss_model, parameters.foliage));
    effects.push_back(std::make_unique<ScintillationIndices>(parameters.scintillation_model, parameters.scintillation,
                                                             context.leap_seconds));
    if (parameters.channel_model.acts() || !parameters.stretches.empty())
        effects.push_back(std::make_unique<SurroundingsEffect>(
            SurroundingsParameters{parameters.channel_model, parameters.stretches, context.run.first},
            parameters.channel, context.seed));
    effects.push_back(std::make_unique<ModernLinkBudget>(parameters, context.seed));
    return effects;
}

}  // namespace skyloop::inline world
