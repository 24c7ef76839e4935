/// Classes of messages, and the items by which ports let protocols through.
#pragma once

#include <cstdint>

namespace skyloop::firmware {

/// Classes of UBX messages that the receiver treats apart; sentences and RTCM have classes too where CFG-MSG names
/// them (u-blox M8 interface description, 32.8 and 31.1.5).
inline constexpr std::uint8_t class_cfg = 0x06, class_mga = 0x13, class_log = 0x21, class_nmea = 0xF0,
                              class_pubx = 0xF1, class_rtcm = 0xF5;

/// Items of the groups CFG-…INPROT and CFG-…OUTPROT (F9 interface description HPG 1.32, CFG-UART1INPROT).
inline constexpr std::uint32_t protocol_ubx = 1, protocol_nmea = 2, protocol_rtcm3 = 4;

}  // namespace skyloop::firmware
