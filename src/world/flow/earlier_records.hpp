/// Satellites that fly on while their broadcast records step.
#pragma once

#include <optional>

#include "base/core/units.hpp"
#include "base/time/gps_time.hpp"

namespace skyloop::inline world {

/// What the records before the present one leave in a range, so that it does not step when the record changes.
struct EarlierRecords {
    /// By how much the range is longer than the present record tells, satellite clock included: all of the step when
    /// the record changes, nothing five minutes later.
    Metres range;
    MetresPerSecond range_rate;  ///< its derivative
    /// The last change, within those five minutes, between records too far apart for one orbit: there the range jumps.
    std::optional<GpsTime> jumped;
};

}  // namespace skyloop::inline world
