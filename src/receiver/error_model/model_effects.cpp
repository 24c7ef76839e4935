#include "receiver/error_model/model_effects.hpp"

#include "world/propagation/sensor_model_delays.hpp"
#include "world/propagation/sensor_model_losses.hpp"

namespace skyloop::inline receiver {
namespace {

Result<std::unique_ptr<PropagationEffect>> ionosphere_effect(const EffectSettings& s) {
    if (s.atmosphere.tec_source == TecSource::ionex) {
        if (!s.maps)
            return fail(ErrorCode::input,
                        "the electron content is to come from maps and none are given; expected an IONEX file");
        if (const auto covered = check_coverage(*s.maps, s.run); !covered) return fail(covered.error());
        return std::make_unique<TecIonosphereDelay>(s.maps->maps);
    }
    const bool wants_broadcast = s.atmosphere.tec_source != TecSource::constant;
    if (wants_broadcast && s.klobuchar) return std::make_unique<TecIonosphereDelay>(*s.klobuchar);
    if (s.atmosphere.tec_source == TecSource::header)
        return fail(ErrorCode::input,
                    s.tec_source_told_at +
                        "is 'header', and the navigation data has no ionosphere coefficients; expected a file that has "
                        "them, or 'automatic' or 'constant'");
    return std::make_unique<TecIonosphereDelay>(s.atmosphere.total_electron_content);
}

}  // namespace

bool takes_electron_content(ErrorModelKind kind) {
    return kind == ErrorModelKind::baseline || kind == ErrorModelKind::whole_path;
}

Result<std::vector<std::unique_ptr<PropagationEffect>>> effects_for(ErrorModelKind kind, const EffectSettings& s) {
    std::vector<std::unique_ptr<PropagationEffect>> effects;
    const bool layered = kind == ErrorModelKind::baseline;
    const bool whole_path = kind == ErrorModelKind::whole_path;
    if (layered) effects.push_back(std::make_unique<LayeredAtmosphereLoss>(s.atmosphere));
    if (whole_path) effects.push_back(std::make_unique<WholePathLoss>(s.whole_path));
    if (takes_electron_content(kind)) {
        auto ionosphere = ionosphere_effect(s);
        if (!ionosphere) return fail(ionosphere.error());
        effects.push_back(std::move(*ionosphere));
        effects.push_back(std::make_unique<NiellTroposphereDelay>(s.atmosphere, s.geoid, s.leap_seconds));
    }
    if (kind == ErrorModelKind::refraction) {
        const ExponentialRefractivity air{s.refraction.surface_refractivity, s.refraction.scale_height};
        effects.push_back(std::make_unique<RefractionDelay>(air, s.geoid));
    }
    effects.push_back(std::make_unique<LinkBudget>(s.link_budget, s.atmosphere.environment_noise));
    return effects;
}

}  // namespace skyloop::inline receiver
