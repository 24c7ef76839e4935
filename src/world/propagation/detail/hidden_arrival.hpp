/// A satellite that does not arrive.
#pragma once

#include "world/flow/arrivals.hpp"

namespace skyloop {

/// Nothing of it reaches the antenna, by whatever way.
inline void hide(Arrival& arrival) {
    arrival.line_of_sight = false;
    arrival.paths = 0;
    arrival.reflections = 0;
    arrival.excess_path = Metres(0);
    arrival.excess_rate = MetresPerSecond(0);
    arrival.reflection_loss = Decibels(0);
    arrival.cn0.reset();
}

}  // namespace skyloop
