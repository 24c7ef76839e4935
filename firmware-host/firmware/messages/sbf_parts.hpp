/// What several SBF blocks have in common.
#pragma once

#include <algorithm>
#include <cstdint>

#include "firmware/messages/field_values.hpp"
#include "firmware/messages/reported_fix.hpp"
#include "skyloop/protocol/sbf_blocks.hpp"

namespace skyloop::firmware {

/// The stamp of what is reported.
inline SbfTime sbf_time(const NavigationState& state) {
    const WeekAndTow stamp = gps_stamp(state);
    SbfTime time;
    if (state.time.time) time.tow = whole_milliseconds(stamp);
    if (state.time.date) time.wnc = field<std::uint16_t>(static_cast<double>(stamp.week));
    return time;
}

/// PVT mode, bits 0-3 and 7 (PolaRx5TR reference guide, PVTGeodetic).
inline std::uint8_t sbf_mode(const NavigationState& state) {
    if (!has_solution(state)) return 0;
    switch (state.epoch.fix.type) {
        case FixType::fix_2d:
            return 0x81;
        case FixType::dgnss:
            return state.corrections.state == CorrectionState::none ? 6 : 2;
        case FixType::rtk_fixed:
            return 4;
        case FixType::rtk_float:
            return 5;
        default:
            return 1;
    }
}

inline std::uint8_t sbf_error(const NavigationState& state) { return has_solution(state) ? 0 : 1; }

/// Clipped to the largest number that still means something.
inline std::uint16_t sbf_u2(double value) { return std::min(field<std::uint16_t>(value), std::uint16_t{65534}); }

/// Bits of the signal types of the satellites used (section 4.1.10).
std::uint32_t sbf_signal_info(const Fix& fix);

}  // namespace skyloop::firmware
