/// A reference station put together from its RTCM 3 messages.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "base/time/gps_time.hpp"
#include "receiver/protocol/rtcm3.hpp"
#include "receiver/protocol/rtcm3_legacy.hpp"
#include "world/flow/reference_station.hpp"

namespace skyloop::firmware {

/// The instant of an observation message, which tells it within a week, or of GLONASS within a day, nearest to another.
/// @param number of the message: 1001 … 1012, 1071 … 1137  @param epoch as it has it  @param leap_seconds GPST − UTC
/// @return nothing for other messages, and what no week or day has
std::optional<GpsTime> told_time(int number, std::uint32_t epoch, GpsTime near, int leap_seconds);

/// Collects the messages of one station. An epoch is handed on with its last message (DF393 says that no more follow),
/// or with the first one of the next epoch.
///
/// State: the station as it is handed on, and the epoch that is coming in.
class ReferenceData {
public:
    explicit ReferenceData(int id) { station_.id = id; }

    void take_position(const Position<Ecef>& antenna);
    /// Of a base that moves (4072.0): where it was when it measured what follows. One that says where it stands does
    /// not.
    void take_moving(const Position<Ecef>& antenna);
    void take_glonass_biases() { station_.glonass_biases_known = true; }
    /// @param now by the receiver's clock
    void take_observations(const Rtcm3MsmObservations& message, GpsTime now, int leap_seconds);
    /// The same of messages that tell whole ranges: 1002, 1004, 1010, 1012.
    void take_observations(const Rtcm3LegacyObservables& message, GpsTime now, int leap_seconds);
    /// Nothing until a position and an epoch have come.
    [[nodiscard]] const std::shared_ptr<const ReferenceStation>& station() const { return handed_on_; }

private:
    void take(std::optional<GpsTime> time, std::vector<Observation> signals, bool more);
    void hand_on();

    bool stands_ = false;
    ReferenceStation station_;
    ReferenceEpoch coming_;
    std::shared_ptr<const ReferenceStation> handed_on_;
};

}  // namespace skyloop::firmware
