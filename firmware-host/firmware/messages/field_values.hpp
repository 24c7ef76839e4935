/// What the fields of several UBX messages have in common: numbers that stay in their range, time, satellites.
/// What the messages of MSP, MAVLink and SBF have in common: which solution is told, and when.
#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "base/time/utc_time.hpp"
#include "firmware/core/navigation_state.hpp"
#include "receiver/protocol/ubx_fields.hpp"
#include "world/gnss/satellite.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop::firmware {

/// A number, rounded as messages of lower precision have it, and what is left of it for a field of higher precision
/// (NAV-HPPOSLLH and its like; 611 epochs of two captured ZED-F9P agree with their NAV-PVT).
/// @param value in units of the rest; not a number is 0 @param parts of these make one unit of the whole: 100 or 10
/// @param rest −parts/2 … parts/2
void put_split(double value, int parts, std::int32_t& whole, std::int8_t& rest);
/// The same for fields. @param value in their declared unit
template <class Whole, class Rest>
void put_split(double value, Whole& whole, Rest& rest) {
    constexpr double parts = Rest::format.divisor / Whole::format.divisor;
    put_split(value * Rest::format.divisor, static_cast<int>(parts), whole.raw, rest.raw);
}
template <class Whole, class Rest>
void put_split(const Eigen::Vector3d& values, Whole& whole, Rest& rest) {
    constexpr double parts = Rest::format.divisor / Whole::format.divisor;
    for (std::size_t i = 0; i < 3; ++i)
        put_split(values[static_cast<Eigen::Index>(i)] * Rest::format.divisor, static_cast<int>(parts), whole[i],
                  rest[i]);
}

/// An accuracy that nobody knows.
inline constexpr std::uint32_t unknown_accuracy = 0xFFFF'FFFF;
/// A DOP that was not computed.
inline constexpr double unknown_dop = 99.99;

/// An epoch in GPS time as messages say it: the nearest millisecond, and the rest.
struct EpochTime {
    std::int64_t week = 0;
    std::uint32_t i_tow = 0;  ///< ms, 0 … 604 799 999
    std::int32_t f_tow = 0;   ///< ns, −500 000 … 500 000
    [[nodiscard]] WeekAndTow stamp() const { return {week, std::chrono::milliseconds(i_tow)}; }
};
EpochTime epoch_time(GpsTime time);
/// Whether satellites stand behind the position, so that it has DOPs: dead reckoning goes on without.
bool has_dops(const Fix& fix);
/// A week number as the receiver counts it. @param now week and time of week, both of the message's own time scale
std::int64_t reported_week(const NavigationState& state, const WeekAndTow& now);
/// The same for a field.
template <class Integer>
Integer week_field(const NavigationState& state, const WeekAndTow& now) {
    return nearest<Integer>(static_cast<double>(reported_week(state, now)));
}

/// The instant of the epoch as the receiver believes it, and how far GPS time is ahead of UTC. The receiver's own clock
/// shows a whole millisecond then, the satellites' the rest that fTOW and nano tell: minus clkB (captures of ZED-F9T
/// and M8T, 881 epochs: within 5 ns).
struct ReportedTime {
    GpsTime time;
    int leap_seconds = 18;
    std::optional<LeapEvent> leap_event{};
};
/// What the receiver counts UTC by.
LeapSeconds counted_leap_seconds(const ReportedTime& now);
/// Before the first time from space a receiver without a clock of its own counts from the week that
/// CFG-NAVSPG-WKNROLLOVER names (M9N 4.04: 2020-08-02, F9P: 2024-06-23; RECEIVER.md 4.9).
ReportedTime reported_time(const ReportContext& context);

/// UTC rounded to 10 ms, and what was rounded away with the hundredths in it (RECEIVER.md 4.9).
struct UtcFields {
    UtcTime utc;            ///< its nanosecond is a multiple of 10 ms
    std::int32_t nano = 0;  ///< ns from utc's whole second, −5 000 000 … 994 999 999
};
/// In a leap second that was announced the receiver counts to 60; any other belief about the offset just subtracts.
UtcFields utc_fields(const ReportedTime& now);

/// The UTC standard of NAV-PVT and NAV-TIMEUTC: 15 until leap seconds are known; then what CFG-NAVSPG-UTCSTANDARD says,
/// or that of the systems in use: 3 USNO with GPS, 6 SU of GLONASS, 5 EU of Galileo, 7 NTSC of BeiDou
/// (RECEIVER.md 4.9).
std::uint8_t utc_standard(const ReportContext& context);

/// 1 σ of the time, ns; `unknown_accuracy` without time.
std::uint32_t time_accuracy_ns(const NavigationState& state);

/// NAV-PVT fixType: 0 none, 1 dead reckoning, 2 2D, 3 3D, 5 time only.
std::uint8_t fix_type_code(const Fix& fix);
/// 0 none, 1 float, 2 fixed.
std::uint8_t carrier_solution(const Fix& fix);
/// True when corrections are in the solution: of a base station or of SBAS.
bool is_differential(const Fix& fix);

/// gnssId of UBX (RECEIVER.md 5.6).
std::uint8_t gnss_id(Constellation constellation);
/// svId of UBX: as RINEX, but SBAS by its PRN.
std::uint8_t sv_id(SatelliteId satellite);
/// The one numbering for all systems of NAV-SVINFO, or nothing where it has none.
std::optional<std::uint8_t> ubx_single_number(SatelliteId satellite);
/// sigId of UBX. @param b1c_for_b1i the receiver tracks B1C and calls it so
std::uint8_t signal_id(SatelliteId satellite, Signal signal, bool b1c_for_b1i = false);
/// freqId: the GLONASS channel + 7; 0 of other systems.
std::uint8_t frequency_id(SatelliteId satellite, Signal signal, Hertz carrier);

/// C/N0 as a field.
inline std::uint8_t cn0_field(const std::optional<DbHz>& cn0) { return cn0 ? nearest<std::uint8_t>(cn0->value()) : 0; }

/// Whether the satellite's place in the sky is known: the position is, and so is an orbit. A report leaves both angles
/// at exactly zero where it does not know them.
bool direction_known(const SatelliteStatus& satellite, const NavigationState& state);
/// Whether the almanac is there: it comes with the leap seconds, or was stored. GLONASS tells those in each frame, and
/// them alone.
inline bool almanac_known(const NavigationState& state) {
    return state.time.leap_seconds && state.time.leap_source != Constellation::glonass;
}

/// A message of the epoch that tells its time of week so far, and nothing else.
template <class Message>
Message stamped(const ReportContext& context) {
    Message m;
    m.i_tow = epoch_time(reported_time(context).time).i_tow;
    return m;
}

/// One frame as a list.
template <class Message>
std::vector<Bytes> ubx_frames_of(const Message& message) {
    return {encode_frame(message)};
}

/// A row of the tables that say which function makes which UBX message.
struct UbxMaker {
    UbxMessageId id;
    std::vector<Bytes> (*make)(const ReportContext&);
};
/// The row of a function that returns the one message to be sent.
template <auto Make>
inline constexpr UbxMaker maker{std::invoke_result_t<decltype(Make), const ReportContext&>::message_id,
                                [](const ReportContext& context) { return ubx_frames_of(Make(context)); }};
/// Empty for a message that has no row.
std::vector<Bytes> made_by(std::span<const UbxMaker> makers, UbxMessageId message, const ReportContext& context);

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

inline std::uint8_t reported_satellites(const Fix& fix) { return nearest<std::uint8_t>(fix.satellites_used()); }

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

/// UTC as POSIX has it, which leaves leap seconds out: µs since 1970, of the nearest millisecond.
inline std::uint64_t posix_microseconds(GpsTime time, int leap_seconds) {
    const std::int64_t gps_us =
        std::chrono::duration_cast<std::chrono::microseconds>(to_gps_time(gps_stamp(time)).time_since_epoch()).count();
    return static_cast<std::uint64_t>(gps_us + (gps_epoch_posix_s - leap_seconds) * 1'000'000);
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
