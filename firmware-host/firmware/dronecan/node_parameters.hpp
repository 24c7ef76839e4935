/// The parameters of a GNSS node that uavcan.protocol.param reads and sets.
#pragma once

#include <cstdint>
#include <vector>

#include "firmware/sentences/sentence_settings.hpp"
#include "receiver/protocol/dronecan_messages.hpp"

namespace skyloop::firmware {

/// What a node has of its own: its id, and what ArduPilot's driver reads and sets (AP_GPS_DroneCAN.cpp).
struct NodeSettings {
    static constexpr std::uint32_t node_id = 5000, gps_type = 5001, moving_base_port = 5002;
};

/// In the layers of LayeredValues.
std::vector<OwnSetting> node_settings(const BoardProfile& board, const ReceiverOptions& options);

/// Sets what the request sets, in RAM, and answers with what holds then. A value out of range, or of another kind than
/// a number, changes nothing. Without such a parameter the answer is empty.
DronecanGetSetResponse get_or_set(const DronecanGetSetRequest& request, SentenceSettings& settings);

/// Puts all that is in force into the flash, or takes everything out of it.
void save_parameters(SentenceSettings& settings);
void erase_parameters(SentenceSettings& settings);

}  // namespace skyloop::firmware
