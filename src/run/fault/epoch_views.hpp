/// What observers make of an epoch that they are shown.
#pragma once

#include <utility>
#include <vector>

#include "base/core/units.hpp"
#include "run/fault/run_observer.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop {

/// One satellite above the antenna, and what the receiver makes of it.
struct SatelliteSeen {
    SatelliteId id;
    Angle azimuth, elevation;
    bool line_of_sight = true;
    bool reflected = false;  ///< what is tracked has been reflected
    bool blocked = false;    ///< nothing arrives
    bool used = false;       ///< in the solution
    bool healthy = true;     ///< by its broadcast
    int paths = 1;           ///< rays that arrive
    /// C/N0 of each signal that the receiver tracks; of a sensor model the first signal's alone.
    std::vector<std::pair<Signal, DbHz>> signals;
};

/// East, north, up.
struct EnuError {
    Metres east, north, up;
};

/// All satellites above the horizon, in the order of the trace.
std::vector<SatelliteSeen> satellites_seen(const EpochSeen& seen);

/// Fix − truth. Only for a fix that has a position.
EnuError enu_error(const TruthState& truth, const Fix& fix);

}  // namespace skyloop
