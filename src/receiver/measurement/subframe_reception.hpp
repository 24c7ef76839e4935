/// Which navigation messages a receiver has received whole.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "base/time/utc_time.hpp"
#include "world/flow/observations.hpp"
#include "world/gnss/ephemeris.hpp"

namespace skyloop::inline receiver {

/// Hands out what tracked satellites have sent since the epoch before: GPS and QZSS L1 C/A subframes of 6 s, Galileo
/// E1-B and E5b-I pairs of pages of 2 s, BeiDou D1 subframes 1 to 3 of 6 s, GLONASS strings 1 to 5 of 2 s on L1. What
/// no record tells is not sent: BeiDou's almanacs and D2, GLONASS' almanacs, SBAS. Satellites that are called unhealthy
/// send so in their ephemerides, in GPS's and QZSS's almanacs and in the records that become whole.
///
/// A message counts when it ended between two epochs and its signal had its code locked at all epochs since it began.
/// Ends are taken in GPS time at the satellite; a way of 70 ms brings those of the last tenth of a second into the next
/// epoch. State: since when each signal is tracked, and when the last epoch was.
class SubframeReception {
public:
    explicit SubframeReception(LeapSeconds leap_seconds = LeapSeconds::announced())
        : leap_seconds_(std::move(leap_seconds)) {}

    /// Epochs come in ascending time. The first one after a gap of more than ten seconds begins anew.
    /// @param sent what the satellites broadcast; records are those of the end of a message
    /// @param time true time of the epoch
    /// @return ascending by time, then satellite and signal
    std::vector<Subframe> receive(const Observations& observations, const NavigationSource& sent, GpsTime time);

private:
    using Tracked = std::pair<SatelliteId, Signal>;
    [[nodiscard]] std::optional<Subframe> message(const Tracked& tracked, const NavigationSource& sent,
                                                  GpsTime end) const;
    void follow(const Observations& observations, GpsTime time);

    LeapSeconds leap_seconds_;
    std::map<Tracked, GpsTime> tracked_since_;
    std::optional<GpsTime> last_;
};

}  // namespace skyloop::inline receiver
