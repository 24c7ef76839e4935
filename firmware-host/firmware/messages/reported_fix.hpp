/// What the messages of MSP, MAVLink and SBF have in common: which solution is told, and when.
#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>

#include "base/time/utc_time.hpp"
#include "firmware/messages/field_values.hpp"
#include "firmware/navigation_state.hpp"

namespace skyloop::firmware {

/// A fix of now, within the user's limits, from satellites.
inline bool has_solution(const NavigationState& state) {
    const Fix& fix = state.epoch.fix;
    return fix.has_position() && fix.type != FixType::dead_reckoning && state.fix_ok;
}

/// The position in the fix is one, if an old one: messages without a flag for it go on with the last.
inline bool has_place(const NavigationState& state) { return has_solution(state) || state.position_known; }

/// As ArduPilot and MAVLink (GPS_FIX_TYPE) number them: 1 none, 2 2D, 3 3D, 4 differential, 5 RTK float, 6 RTK fixed.
inline std::uint8_t autopilot_fix_type(const NavigationState& state) {
    if (!has_solution(state)) return 1;
    switch (state.epoch.fix.type) {
        case FixType::fix_2d:
            return 2;
        case FixType::dgnss:
            return 4;
        case FixType::rtk_float:
            return 5;
        case FixType::rtk_fixed:
            return 6;
        default:
            return 3;
    }
}

inline std::uint8_t reported_satellites(const Fix& fix) { return field<std::uint8_t>(fix.satellites_used()); }

/// Metres above mean sea level.
inline double msl_height(const Fix& fix) {
    return above_sea_level(fix.position.height, fix.geoid_undulation).above_sea_level.value();
}

/// The epoch in GPS time, rounded to milliseconds.
inline WeekAndTow gps_stamp(GpsTime time) { return week_and_tow(std::chrono::round<std::chrono::milliseconds>(time)); }
/// The same of what is reported, its week as the receiver counts it.
inline WeekAndTow gps_stamp(const NavigationState& state) {
    const WeekAndTow stamp = gps_stamp(state.epoch.fix.time);
    return {reported_week(state, stamp), stamp.tow};
}
inline std::uint32_t whole_milliseconds(const WeekAndTow& stamp) {
    return static_cast<std::uint32_t>(std::chrono::duration_cast<std::chrono::milliseconds>(stamp.tow).count());
}

/// What the receiver counts UTC by at the epoch, and that time, rounded to milliseconds.
inline LeapSeconds reported_leap_seconds(const NavigationState& state) {
    const Fix& fix = state.epoch.fix;
    return counted_leap_seconds({fix.time, fix.leap_seconds, state.leap_event});
}
inline UtcTime reported_utc(const NavigationState& state) {
    return to_utc(to_gps_time(gps_stamp(state.epoch.fix.time)), reported_leap_seconds(state));
}

/// Where the vector between the antennas of a pair points.
struct PairAttitude {
    double heading_deg = 0;  ///< 0 … 360, from true north
    double pitch_deg = 0;    ///< up positive
    bool fixed = false;      ///< the ambiguities are whole numbers
};
/// Nothing without a pair whose base moves.
inline std::optional<PairAttitude> pair_attitude(const NavigationState& state) {
    if (!state.epoch.relative || !state.epoch.relative->base_moves) return std::nullopt;
    const RelativePosition& r = *state.epoch.relative;
    const double horizontal = std::hypot(r.north_m, r.east_m);
    if (!(horizontal > 0)) return std::nullopt;
    constexpr double degrees = 180.0 / std::numbers::pi;
    const double heading = std::atan2(r.east_m, r.north_m) * degrees;
    return PairAttitude{heading < 0 ? heading + 360 : heading, std::atan2(-r.down_m, horizontal) * degrees, r.fixed};
}

}  // namespace skyloop::firmware
