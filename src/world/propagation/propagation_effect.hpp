/// One cause of delay or loss between a satellite and the antenna.
/// Signals in empty space: the start of everything that arrives.
/// A satellite that does not arrive.
#pragma once

#include <cassert>

#include "base/core/units.hpp"
#include "world/flow/arrivals.hpp"
#include "world/flow/sky_view.hpp"
#include "world/flow/truth_state.hpp"

namespace skyloop::inline world {

/// Changes what arrives. Effects are applied in a fixed order; each writes only the fields of its own cause.
class PropagationEffect {
public:
    virtual ~PropagationEffect() = default;
    /// @param arrivals one for each satellite of `sky`, in its order
    virtual void apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) = 0;
};

/// Calls with(arrival, satellite) for each satellite of `sky`. @param arrivals one for each, in its order
template <class With>
void for_each_arrival(Arrivals& arrivals, const SkyView& sky, With&& with) {
    assert(arrivals.satellites.size() == sky.satellites.size());
    for (std::size_t i = 0; i < sky.satellites.size(); ++i)
        with(arrivals.satellites[i], sky.satellites[i]);
}

/// Where a satellite stands in the antenna's sky.
inline SkyDirection direction_of(const SatelliteInView& satellite) { return {satellite.azimuth, satellite.elevation}; }

/// 20 log10(4π d f / c) (MODELS.md 3.6, L_s).
Decibels free_space_loss(Metres distance, Hertz carrier);

/// The carrier of the satellite's first signal; L1 for a satellite without signals.
Hertz first_carrier(const Arrival& arrival);

/// One arrival for each satellite of `sky`, in its order: in line of sight, without delay, weakened by distance alone.
Arrivals free_space(const SkyView& sky);

/// Nothing of it reaches the antenna, by whatever way.
inline void hide(Arrival& arrival) {
    arrival.line_of_sight = false;
    arrival.paths = 0;
    arrival.reflections = 0;
    arrival.excess_path = Metres(0);
    arrival.excess_rate = MetresPerSecond(0);
    arrival.reflection_loss = Decibels(0);
    arrival.shadowing_loss = Decibels(0);
    arrival.cn0.reset();
}

}  // namespace skyloop::inline world
