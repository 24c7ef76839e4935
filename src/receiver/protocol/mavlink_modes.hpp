/// What flight modes are called that HEARTBEAT tells as numbers.
///
/// Names and numbers: ArduPilot by COPTER_MODE, PLANE_MODE and ROVER_MODE of MAVLink's ardupilotmega.xml, named as its
/// ground stations do (FBWA, not FLY_BY_WIRE_A); PX4 by the main modes and the submodes of AUTO in its
/// src/modules/commander/px4_custom_mode.h. Kinds of vehicles: MAV_TYPE of minimal.xml.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "receiver/protocol/mavlink.hpp"

namespace skyloop {

inline constexpr std::uint8_t mavlink_autopilot_ardupilot = 3, mavlink_autopilot_none = 8, mavlink_autopilot_px4 = 12;
/// Bits of HEARTBEAT's base_mode: custom_mode holds, motors may turn.
inline constexpr std::uint8_t mavlink_custom_mode_enabled = 1, mavlink_safety_armed = 128;

/// "AUTO", "RTL", of PX4 "POSCTL" or with its submode "AUTO.MISSION"; empty when the mode, the autopilot or the kind of
/// vehicle is not known here, or custom_mode does not hold.
std::string mavlink_mode_name(const MavlinkHeartbeat& heartbeat);

/// True when `name` is the mode `mode` or the one that has it as a submode: "AUTO.MISSION" is "AUTO", too. Letters may
/// be of either case.
bool is_mavlink_mode(std::string_view mode, std::string_view name);

/// All names that mavlink_mode_name() can give, ascending, without repetition.
const std::vector<std::string>& mavlink_mode_names();

}  // namespace skyloop
