/// What stands around the antenna as an effect on what arrives.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "base/core/random.hpp"
#include "world/propagation/propagation_effect.hpp"
#include "world/propagation/state_channel.hpp"
#include "world/propagation/surroundings_stretch.hpp"

namespace skyloop::inline world {

/// The surroundings of a run.
struct SurroundingsParameters {
    ChannelParameters everywhere;                  ///< where no stretch is, with the roof of the vehicle
    std::vector<SurroundingsStretch> stretches{};  ///< of those that overlap, the last one
    GpsTime start{};                               ///< of the run
};

/// Writes what a StateChannel does to each satellite that no scene describes (`echoes_known`): shadowing_loss and the
/// echoes, and where the direct ray is weaker than an echo, that echo as the ray that is tracked: line_of_sight,
/// excess_path and excess_rate. On the ramps of a stretch, losses in dB and echoes in amplitude pass over.
///
/// A roof of loss R takes R · (sin e − sin 35°)/(1 − sin 35°) from the direct ray above 35°, and nothing below. Ours:
/// windows let pass what comes from lower down. A cover weakens every ray but those through the openings of its
/// stretch, as far as their directions lead there; an edge is a metre wide, as Fresnel's zone is at 5 m.
///
/// State: the way travelled and the last heading.
class SurroundingsEffect : public PropagationEffect {
public:
    SurroundingsEffect(const SurroundingsParameters& parameters, const ErrorTerm& term, std::uint64_t seed);
    void apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) override;

private:
    static constexpr double never = std::numeric_limits<double>::infinity();
    struct Part {
        explicit Part(const ChannelParameters& parameters, std::uint64_t seed);
        std::optional<StateChannel> channel;  // nothing: an open sky
        ChannelParameters parameters;
        std::optional<SurroundingsStretch> stretch{};
        StretchPlace place{1, true, never, never};  // of the epoch
    };
    void move_to(const TruthState& truth, const Eigen::Vector2d& velocity);

    std::vector<Part> parts_;
    GpsTime start_;
    double factor_;
    Decibels roof_;
    Whereabouts antenna_;
    std::optional<Position<Ecef>> before_;
};

/// Where an antenna is on the plane of StateChannel: metres along meridians, and along the parallel of the nearest
/// whole degree of latitude, so that neighbours see the same; heights do not matter.
ChannelPlace channel_place(const TruthState& truth);

/// What a sample makes of an arrival that nothing has touched: the strongest ray is tracked.
/// @param more_loss of the direct ray
void meet_surroundings(Arrival& arrival, const ChannelSample& sample, Decibels more_loss);

/// Part of the way from one sample to another, for the same satellite under the same seed: dB of the direct ray,
/// amplitudes of the echoes. @param weight of the other, 0 … 1
ChannelSample between(const ChannelSample& one, const ChannelSample& other, double weight);

/// What a cover takes from a ray that comes from a direction, 0 … all of it.
Decibels cover_loss(const ChannelParameters& parameters, const StretchPlace& place, std::optional<Angle> heading,
                    const SkyDirection& direction);

}  // namespace skyloop::inline world
