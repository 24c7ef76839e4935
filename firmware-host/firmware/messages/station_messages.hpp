/// RTCM 3 of base stations, whoever made them.
#pragma once

#include <span>
#include <vector>

#include "firmware/messages/make_message.hpp"

namespace skyloop::firmware {

/// What a base sends of a message of class F5: beside those of make_rtcm_message() 1006 and 1033, the receiver's name.
/// @param following as EpochMessages::of()
std::vector<Bytes> make_station_message(UbxMessageId message, EpochMessages& made, PortId port,
                                        std::span<const UbxMessageId> following);

}  // namespace skyloop::firmware
