// PUBX,00, 03 and 04 (RECEIVER.md 5.7).
#include <algorithm>
#include <cmath>

#include "firmware/messages/nmea_report.hpp"
#include "receiver/protocol/nmea_pubx.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::firmware {
namespace {

// What a receiver says of a position that it never had (capture in RECEIVER.md 5.7).
constexpr Metres no_horizontal_accuracy{5303356}, no_vertical_accuracy{3750039};

std::string navigation_status(const NmeaReport& r) {
    if (r.fix().type == FixType::time_only) return "TT";
    if (!r.valid) return "NF";
    switch (r.fix().type) {
        case FixType::dead_reckoning:
            return "DR";
        case FixType::fix_2d:
            return "G2";
        case FixType::fix_3d:
            return "G3";
        default:
            return "D3";
    }
}

PubxPosition pubx_position(const NmeaReport& r) {
    const NavigationState& state = r.context.state;
    const Fix& fix = r.fix();
    PubxPosition m;
    m.time = r.time;
    m.status = navigation_status(r);
    m.horizontal_accuracy = no_horizontal_accuracy;
    m.vertical_accuracy = no_vertical_accuracy;
    if (!state.position_known && !r.solved) return m;
    m.position = {fix.position.latitude, fix.position.longitude};
    m.altitude = fix.position.height.above_ellipsoid;
    if (!state.only_place_known) {
        m.horizontal_accuracy = fix.horizontal_accuracy;
        m.vertical_accuracy = fix.vertical_accuracy;
    }
    m.speed = fix.speed;
    m.course = state.course.value_or(fix.course);
    m.down = MetresPerSecond(fix.velocity.down);
    if (!r.solved) return m;
    if (state.corrections.state != CorrectionState::none && state.corrections.age)
        m.correction_age_s = static_cast<int>(std::lround(state.corrections.age->value()));
    if (has_dops(fix)) {
        m.hdop = fix.dop.hdop;
        m.vdop = fix.dop.vdop;
        m.tdop = fix.dop.tdop;
    }
    m.satellites_used = r.satellites_counted;
    m.dead_reckoning = fix.type == FixType::dead_reckoning;
    return m;
}

// Of the longest held signal; who measures nothing has held it for long.
int lock_seconds(const NmeaReport& r, const SatelliteStatus& s) {
    constexpr int longest = 64;
    const auto& observed = r.context.state.epoch.observations.signals;
    if (!s.cn0) return 0;
    if (observed.empty()) return longest;
    double lock = 0;
    for (const Observation& o : observed)
        if (o.satellite == s.id) lock = std::max(lock, o.lock_time.value());
    return static_cast<int>(std::min<double>(lock, longest));
}

PubxSatellites pubx_satellites(const NmeaReport& r) {
    PubxSatellites m;
    for (const SatelliteStatus& s : r.satellites) {
        const auto number = single_byte_number(s.id);
        if (!number) continue;
        PubxSatellite line;
        line.number = *number;
        line.status = s.used && r.solved ? 'U' : s.has_ephemeris ? 'e' : '-';
        if (direction_known(s, r.context.state)) {
            line.azimuth_deg = (static_cast<int>(std::lround(s.azimuth.deg())) % 360 + 360) % 360;
            line.elevation_deg = std::clamp(static_cast<int>(std::lround(s.elevation.deg())), 0, 90);
        }
        if (s.cn0) line.cn0_dbhz = static_cast<int>(std::lround(std::clamp(s.cn0->value(), 0.0, 99.0)));
        line.lock_s = lock_seconds(r, s);
        m.satellites.push_back(line);
    }
    return m;
}

PubxTime pubx_time(const NmeaReport& r) {
    constexpr double nanoseconds = 1e9;
    constexpr int granularity_ns = 16;  // capture of an M8 in RECEIVER.md 5.7
    const Fix& fix = r.fix();
    PubxTime m;
    m.time = r.time;
    m.date = r.date;
    if (r.context.state.time.time && r.context.state.time.date) {
        const WeekAndTow utc = week_and_tow(to_gps_time(reported_utc(r.context), LeapSeconds::constant(0)));
        m.utc_week = static_cast<int>(reported_week(r.context.state, utc));
        m.utc_tow_s = utc.tow_seconds();
    }
    m.leap_seconds = fix.leap_seconds;
    m.leap_seconds_by_default = !r.context.state.time.leap_seconds;
    m.clock_bias_ns = fix.clock_bias.value() / speed_of_light * nanoseconds;
    m.clock_drift_ns_s = fix.clock_drift.value() / speed_of_light * nanoseconds;
    m.granularity_ns = granularity_ns;
    return m;
}

}  // namespace

std::vector<Bytes> pubx_sentences(int number, const NmeaReport& r) {
    switch (number) {
        case 0:
            return {to_bytes(encode(pubx_position(r), r.format))};
        case 3:
            return {to_bytes(encode(pubx_satellites(r), r.format))};
        case 4:
            return {to_bytes(encode(pubx_time(r), r.format))};
        default:
            return {};
    }
}

}  // namespace skyloop::firmware
