/// Every number of what stands around the antenna.
#pragma once

#include <optional>

#include "base/core/units.hpp"
#include "world/propagation/p681_two_state.hpp"

namespace skyloop::inline world {

/// How surroundings that no scene describes weaken, scatter and delay signals. What is not of P.681-11 is ours; the
/// values that a word for the surroundings sets are in surroundings.cpp.
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
    /// Of the walls or slopes on both sides of a street: the mean elevation of their tops, seen square to the street,
    /// and its deviation from house to house. 0: none, and the environment's odds hold.
    Angle wall, wall_spread = Angle::degrees(10);
    std::optional<Angle> street{};  ///< azimuth of it; nothing: that of the motion, by the seed before any
    /// Of what is above and around, as a tunnel's rock, which leaves openings where it begins and ends: as wide to each
    /// side of the antenna, and as high above it.
    Decibels cover{0};
    Metres opening_side{5}, opening_height{4};
    /// Whether there is anything at all.
    [[nodiscard]] bool acts() const { return environment || cover > Decibels(0); }
};

}  // namespace skyloop::inline world
