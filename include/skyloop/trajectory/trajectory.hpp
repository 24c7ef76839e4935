/// Where the antenna is over time.
#pragma once

#include "skyloop/flow/truth_state.hpp"
#include "skyloop/time/gps_time.hpp"

namespace skyloop {

/// A path of the antenna.
class Trajectory {
public:
    virtual ~Trajectory() = default;
    /// The true state at `time`; before its start a path stands at its beginning, after its end at its last point.
    [[nodiscard]] virtual TruthState at(GpsTime time) const = 0;
};

}  // namespace skyloop
