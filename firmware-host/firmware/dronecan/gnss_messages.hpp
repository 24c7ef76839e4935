/// From the receiver's state to the messages of a GNSS node.
#pragma once

#include <optional>

#include "firmware/core/navigation_state.hpp"
#include "receiver/protocol/dronecan_messages.hpp"

namespace skyloop::firmware {

/// The last position stays without a fix, as AP_Periph, whose status then is 0 (ArduPilot, Tools/AP_Periph/gps.cpp).
/// Times are of UTC, none before it is known. Always with six covariances, since ArduPilot reads accuracies from no
/// other number of them (AP_GPS_DroneCAN.cpp): of the horizontal axes the square of the horizontal accuracy, as
/// AP_Periph has it; what is not known, or more than half precision holds, is not a number.
/// @param now when it leaves
DronecanFix2 dronecan_fix(const NavigationState& state, GpsTime now);
DronecanAuxiliary dronecan_auxiliary(const NavigationState& state);
/// Nothing without a pair of antennas.
std::optional<DronecanHeading> dronecan_heading(const NavigationState& state);
std::optional<DronecanRelPosHeading> dronecan_relative_heading(const NavigationState& state);

}  // namespace skyloop::firmware
