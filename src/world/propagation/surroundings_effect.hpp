/// What stands around the antenna as an effect on what arrives.
#pragma once

#include <cstdint>

#include "base/core/random.hpp"
#include "world/propagation/propagation_effect.hpp"
#include "world/propagation/state_channel.hpp"

namespace skyloop::inline world {

/// Writes what a StateChannel does to each satellite that no scene describes (`echoes_known`): shadowing_loss and the
/// echoes, and where the direct ray is weaker than an echo, that echo as the ray that is tracked: line_of_sight,
/// excess_path and excess_rate.
///
/// A roof of loss R takes R · (sin e − sin 35°)/(1 − sin 35°) from the direct ray above 35°, and nothing below. Ours:
/// windows let pass what comes from lower down.
class SurroundingsEffect : public PropagationEffect {
public:
    SurroundingsEffect(const ChannelParameters& parameters, const ErrorTerm& term, std::uint64_t seed);
    void apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) override;

private:
    StateChannel channel_;
    double factor_;
    Decibels roof_;
};

/// Where an antenna is on the plane of StateChannel: metres along meridians, and along the parallel of the nearest
/// whole degree of latitude, so that neighbours see the same; heights do not matter.
ChannelPlace channel_place(const TruthState& truth);

}  // namespace skyloop::inline world
