/// A reference station put together from its RTCM 3 messages.
#pragma once

#include <memory>
#include <optional>

#include "base/time/gps_time.hpp"
#include "receiver/protocol/rtcm3.hpp"
#include "world/flow/reference_station.hpp"

namespace skyloop::firmware {

/// The instant that a multiple signal message tells, which is within half a week (GLONASS: half a day) of another.
/// @param leap_seconds GPST − UTC  @return nothing for a GLONASS day that has no such time
std::optional<GpsTime> told_time(const Rtcm3MsmObservations& message, GpsTime near, int leap_seconds);

/// Collects the messages of one station. An epoch is handed on with its last message (DF393 says that no more follow),
/// or with the first one of the next epoch.
///
/// State: the station as it is handed on, and the epoch that is coming in.
class ReferenceData {
public:
    explicit ReferenceData(int id) { station_.id = id; }

    void take_position(const Rtcm3Station& told);
    void take_glonass_biases() { station_.glonass_biases_known = true; }
    /// @param now by the receiver's clock  @return false for observations of which nothing can be used
    bool take_observations(const Rtcm3MsmObservations& message, GpsTime now, int leap_seconds);
    /// Nothing until a position and an epoch have come.
    [[nodiscard]] const std::shared_ptr<const ReferenceStation>& station() const { return handed_on_; }

private:
    void hand_on();

    ReferenceStation station_;
    ReferenceEpoch coming_;
    std::shared_ptr<const ReferenceStation> handed_on_;
};

}  // namespace skyloop::firmware
