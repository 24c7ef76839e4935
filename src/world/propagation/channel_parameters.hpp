/// Every number of what stands around the antenna.
#pragma once

#include <optional>

#include "base/core/units.hpp"
#include "world/propagation/p681_two_state.hpp"

namespace skyloop::inline world {

/// How surroundings that no scene describes weaken, scatter and delay signals. What is not of P.681-11 is ours; the
/// values that a word for the surroundings sets are in surroundings_table.cpp.
struct ChannelParameters {
    std::optional<P681Environment> environment;  ///< nothing: an open sky, no channel
    double distance_scale = 1;                   ///< of the table's durations and correlation lengths
    double bad_odds = 1;                         ///< factor on P(bad) / P(good) of the table
    Decibels good_loss{0}, bad_loss{0};          ///< more of it in a state, beside the table
    double shadowing_scale = 1;                  ///< of the table's Σ_A
    Decibels diffuse{0};                         ///< more of the table's diffuse power
    Angle reach = Angle::degrees(30);            ///< of an obstacle over the sky: no correlation beyond
    MetresPerSecond creep{0.01};                 ///< at which states change at rest, by the satellites' motion and wind
    Hertz beat{0.004};                           ///< 1 σ of the echoes' frequency against the direct ray at rest
    Seconds averaging{0.5};                      ///< over which receivers average what fades
    Metres echo_delay{15};                       ///< mean excess of the echoes
    Metres echo_length{15};                      ///< way over which an echo keeps its excess
    Decibels roof{0};                            ///< loss of a roof above the antenna towards the zenith
};

}  // namespace skyloop::inline world
