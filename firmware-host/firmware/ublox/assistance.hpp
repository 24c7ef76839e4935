/// What a u-blox receiver says to assistance, UBX class MGA.
#pragma once

#include <cstdint>

#include "receiver/protocol/ubx_frame.hpp"

namespace skyloop::firmware {

/// infoCode of MGA-ACK-DATA0 (u-blox M8 interface description, 32.16.1). There are 4, not stored, and 5, not ready,
/// too.
enum class AssistanceInfo : std::uint8_t {
    accepted = 0,
    time_unknown = 1,
    other_version = 2,
    wrong_size = 3,
    unknown_type = 6
};

/// Whether a message would be used. @param time_known ephemerides, almanacs and AssistNow Offline need the time
AssistanceInfo judge_assistance(const UbxFrameView& frame, bool time_known);

/// Whether it tells the time: MGA-INI-TIME_UTC and TIME_GNSS.
bool tells_time(const UbxFrameView& frame);

}  // namespace skyloop::firmware
