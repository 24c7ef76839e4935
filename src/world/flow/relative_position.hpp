/// From one antenna of a pair to the other.
#pragma once

#include "base/core/units.hpp"
#include "world/gnss/satellite.hpp"

namespace skyloop {

/// The vector from the base antenna to this one, as the receiver solved it.
struct RelativePosition {
    double north_m = 0, east_m = 0, down_m = 0;
    Metres deviation;        ///< 1 σ of each part
    bool base_moves = true;  ///< a moving base: the heading of the vector means something
    bool fixed = true;       ///< the ambiguities are whole numbers
    int base_station = 0;    ///< 0 … 4095
};

}  // namespace skyloop
