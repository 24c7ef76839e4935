/// Words for what stands around an antenna, and the numbers that each sets.
#pragma once

#include <string_view>

#include "world/propagation/channel_parameters.hpp"

namespace skyloop::inline world {

/// What no scene describes.
enum class Surroundings {
    open_sky,
    rural,           ///< a road between fields
    residential,     ///< gardens, houses and trees
    forest,          ///< under trees
    suburban_drive,  ///< roads through suburbs
    urban,           ///< streets of a town
    urban_canyon,    ///< a narrow street between high houses
    indoor_window,   ///< a room, near its window
    valley,          ///< between slopes
    tunnel,          ///< or below a bridge
    garage,          ///< a car park with open sides
};
inline constexpr std::string_view surroundings_names[] = {"open-sky",       "rural",  "residential",  "forest",
                                                          "suburban-drive", "urban",  "urban-canyon", "indoor-window",
                                                          "valley",         "tunnel", "garage"};

/// The channel's numbers; an open sky has none.
ChannelParameters channel_of(Surroundings surroundings);

/// Towards the zenith. Fitted to a record of one car (tools/validate, car).
inline constexpr Decibels loss_of_car_roof{4};

}  // namespace skyloop::inline world
