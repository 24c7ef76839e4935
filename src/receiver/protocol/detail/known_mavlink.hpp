/// The one list of the MAVLink messages that are known here.
#pragma once

#include "receiver/protocol/mavlink.hpp"
#include "receiver/protocol/mavlink_vehicle.hpp"

namespace skyloop {

template <class... Message>
struct MavlinkMessages {
    /// Calls `f.template operator()<Message>()` for one after the other, until one says true; whether one did.
    template <class F>
    static bool any(F&& f) {
        return (f.template operator()<Message>() || ...);
    }
};

using KnownMavlinkMessages =
    MavlinkMessages<MavlinkHeartbeat, MavlinkSystemTime, MavlinkGpsRawInt, MavlinkAttitude, MavlinkAttitudeQuaternion,
                    MavlinkLocalPositionNed, MavlinkGlobalPositionInt, MavlinkGpsGlobalOrigin, MavlinkCommandInt,
                    MavlinkCommandLong, MavlinkCommandAck, MavlinkSimState, MavlinkHilGps, MavlinkHilStateQuaternion,
                    MavlinkGpsInput, MavlinkGpsRtcmData, MavlinkOdometry>;

}  // namespace skyloop
