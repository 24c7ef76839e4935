/// From the receiver's state to the messages of receivers that are no NMEA or UBX ones: MSP, MAVLink and SBF.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "firmware/core/navigation_state.hpp"
#include "receiver/protocol/mavlink.hpp"
#include "receiver/protocol/msp.hpp"
#include "receiver/protocol/sbf_blocks.hpp"

namespace skyloop::firmware {

/// What a component of MAVLink has sent since its start.
struct MavlinkSent {
    std::uint8_t sequence = 0;                  ///< of the next frame
    std::optional<std::int64_t> beat_second{};  ///< of the receiver's time since its start: of the last HEARTBEAT
};

/// GPS_INPUT, and HEARTBEAT before the first one of each second.
std::vector<Bytes> mavlink_messages(const NavigationState& state, MavlinkSent& sent);

/// Its values without a fix: fix type 0, the last position, zeros before the first, velocity 0, accuracies 65535, DOP
/// 99.99; week 65535 while time is not known. The position stays since the receivers that speak it, ArduPilot's
/// peripherals, send the last one that they know (Tools/AP_Periph/msp.cpp, send_msp_GPS()), and clients take it as it
/// comes (Betaflight, src/main/msp/msp.c; INAV, src/main/io/gps_msp.c).
MspSensorGps msp_sensor_gps(const NavigationState& state);
/// Its values without a fix: the last position, zeros before the first, and zeros else.
MspSetRawGps msp_set_raw_gps(const NavigationState& state);
/// Its values without a fix: fix type 1, the last position, zeros before the first, all other ignore flags, DOP 65535;
/// times 0 while time is not known. Latitude and longitude have no flag, and ArduPilot takes them as they come
/// (AP_GPS_MAV.cpp). The flag of a DOP that is not known is set with a fix, too.
MavlinkGpsInput mavlink_gps_input(const NavigationState& state);

/// Their values without a fix: those that mean nothing (sbf_blocks.hpp), with error 1.
SbfPvtGeodetic sbf_pvt_geodetic(const ReportContext& context);
SbfPosCovGeodetic sbf_position_covariance(const NavigationState& state);
SbfVelCovGeodetic sbf_velocity_covariance(const NavigationState& state);
SbfDop sbf_dop(const NavigationState& state);
SbfAttEuler sbf_attitude(const NavigationState& state);
/// The vector of a pair of receivers, as if the other antenna were the main one; none without a pair.
SbfAuxAntPositions sbf_other_antenna(const NavigationState& state);
SbfEndOfPvt sbf_end_of_pvt(const NavigationState& state);
SbfChannelStatus sbf_channel_status(const NavigationState& state);
SbfReceiverStatus sbf_receiver_status(const NavigationState& state);

}  // namespace skyloop::firmware
