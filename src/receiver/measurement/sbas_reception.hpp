/// Which messages of SBAS satellites a receiver has received whole.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "world/flow/observations.hpp"
#include "world/gnss/sbas_message.hpp"

namespace skyloop::inline receiver {

/// Hands out what tracked SBAS satellites have sent on L1 since the epoch before: a message of 250 bits each second. It
/// counts when it ended between two epochs and its signal had its code locked, at 28 dBHz or more, at all epochs since
/// it began. A satellite that is called unhealthy sends message 0.
///
/// State: since when each satellite is heard, and when the last epoch was.
class SbasReception {
public:
    /// Epochs come in ascending time. The first one after a gap of more than ten seconds begins anew.
    /// @param sent what the satellites send; where they send nothing, so does this @param time true time of the epoch
    /// @return ascending by time, then satellite
    std::vector<Subframe> receive(const Observations& observations, SbasSource& sent, GpsTime time);

private:
    struct Heard {
        GpsTime since;
        bool unhealthy = false;
    };
    void follow(const Observations& observations, GpsTime time);

    std::map<SatelliteId, Heard> heard_;
    std::optional<GpsTime> last_;
};

}  // namespace skyloop::inline receiver
