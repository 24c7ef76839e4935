/// Frames and transfers of DroneCAN as named values.
#pragma once

#include <optional>

#include "receiver/protocol/decoded_message.hpp"
#include "receiver/protocol/dronecan_transfer.hpp"

namespace skyloop::inline receiver {

/// Fills id, name and fields of a message whose protocol and size are set: of a frame that is a whole transfer what
/// that says, of any other its head and bytes.
void list_can(const CanFrame& frame, DecodedMessage& message);
/// The same of a whole transfer. A payload that is not as its type says stays bytes.
void list_dronecan(const DronecanTransfer& transfer, DecodedMessage& message);

}  // namespace skyloop::inline receiver
