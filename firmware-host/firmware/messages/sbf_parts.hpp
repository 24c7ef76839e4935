/// What several SBF blocks have in common.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "firmware/messages/field_values.hpp"
#include "firmware/messages/reported_fix.hpp"
#include "receiver/protocol/sbf_blocks.hpp"

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
    constexpr std::uint8_t fixed_location = 3;
    if (!has_solution(state)) return 0;
    if (state.place_given) return fixed_location;
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

/// 1 too few measurements; of a solution that its user does not want: 8 too few corrections, 10 ambiguities not fixed.
inline std::uint8_t sbf_error(const NavigationState& state) {
    constexpr std::uint8_t measurements = 1, corrections = 8, not_fixed = 10;
    if (has_solution(state)) return 0;
    if (!state.kind_forbidden) return measurements;
    return state.epoch.fix.type == FixType::rtk_float ? not_fixed : corrections;
}

/// Clipped to the largest number that still means something.
inline std::uint16_t sbf_u2(double value) { return std::min(field<std::uint16_t>(value), std::uint16_t{65534}); }

/// The number of a signal (section 4.1.10); nothing for one that has none below 31.
std::optional<std::uint8_t> sbf_signal_number(Constellation constellation, Signal signal);
/// Bits of the signals of the satellites used: those measured, or the first one of a model that measures nothing.
std::uint32_t sbf_signal_info(const NavigationState& state);
/// The channel by which a satellite is tracked, as ChannelStatus numbers them, from 1 on; 0 where it is not.
std::uint8_t sbf_channel_number(const NavigationState& state, SatelliteId satellite);
/// Of GLONASS, channel + 8, by what was measured of the satellite; of other systems, and where nothing was, 0.
std::uint8_t sbf_frequency_number(SatelliteId satellite, const Observations& observations);

}  // namespace skyloop::firmware
