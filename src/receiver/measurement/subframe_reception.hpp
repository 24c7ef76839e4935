/// Which navigation messages a receiver has received whole.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "base/time/utc_time.hpp"
#include "world/flow/observations.hpp"
#include "world/gnss/broadcast_glonass.hpp"
#include "world/gnss/ephemeris.hpp"
#include "world/osnma/osnma_sender.hpp"

namespace skyloop::inline receiver {

/// Hands out what tracked satellites have sent since the epoch before: GPS and QZSS L1 C/A subframes of 6 s, their CNAV
/// messages of 12 s (L2C) and 6 s (L5), Galileo E1-B and E5b-I pairs of pages of 2 s, E5a-I pages of 10 s, BeiDou D1
/// subframes 1 to 3 of 6 s, of geostationary ones D2's subframe 1 of 0.6 s, GLONASS strings of 2 s on L1. What no
/// record tells is not sent: BeiDou's almanacs and corrections, SBAS. Satellites that are called unhealthy send so in
/// their ephemerides, in GPS's and QZSS's almanacs and in the records that become whole.
///
/// A message counts when it ended between two epochs and its signal had its code locked at all epochs since it began.
/// Ends are taken in GPS time at the satellite; a way of 70 ms brings those of the last tenth of a second into the next
/// epoch. State: since when each signal is tracked, when the last epoch was, and almanacs at hand.
class SubframeReception {
public:
    explicit SubframeReception(LeapSeconds leap_seconds = LeapSeconds::announced())
        : leap_seconds_(std::move(leap_seconds)) {}

    /// From now on the pages of Galileo's E1-B are authenticated.
    void authenticate(std::shared_ptr<const OsnmaKeys> keys) { osnma_.emplace(std::move(keys)); }

    /// Epochs come in ascending time. The first one after a gap of more than ten seconds begins anew.
    /// @param sent what the satellites broadcast; records are those of the end of a message
    /// @param time true time of the epoch
    /// @return ascending by time, then satellite and signal
    std::vector<Subframe> receive(const Observations& observations, const NavigationSource& sent, GpsTime time);

private:
    using Tracked = std::pair<SatelliteId, Signal>;
    [[nodiscard]] std::optional<Subframe> message(const Tracked& tracked, const NavigationSource& sent, GpsTime end);
    void follow(const Observations& observations, GpsTime time);

    LeapSeconds leap_seconds_;
    GlonassAlmanacStrings glonass_almanacs_;
    std::optional<OsnmaSender> osnma_;
    std::map<Tracked, GpsTime> tracked_since_;
    std::optional<GpsTime> last_;
};

}  // namespace skyloop::inline receiver
