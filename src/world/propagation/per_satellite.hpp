/// What an effect keeps for each satellite that it has met.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "world/gnss/satellite.hpp"

namespace skyloop::inline world {

/// States by satellite, in a sorted vector: few, and looked up at every epoch.
template <class State>
class PerSatellite {
public:
    /// The state of a satellite. @param make makes it, from the satellite, when it is met for the first time
    template <class Make>
    State& of(SatelliteId satellite, Make&& make) {
        const auto at =
            std::lower_bound(states_.begin(), states_.end(), satellite,
                             [](const std::pair<SatelliteId, State>& s, SatelliteId id) { return s.first < id; });
        if (at != states_.end() && at->first == satellite) return at->second;
        return states_.emplace(at, satellite, make(satellite))->second;
    }

private:
    std::vector<std::pair<SatelliteId, State>> states_;
};

}  // namespace skyloop::inline world
