#include "firmware/output_only/other_protocols.hpp"

#include <cmath>
#include <utility>

#include "firmware/messages/field_values.hpp"

namespace skyloop::firmware {
namespace {

// GPS_INPUT_IGNORE_FLAGS of common.xml.
constexpr std::uint16_t ignore_alt = 1, ignore_hdop = 2, ignore_vdop = 4, every_ignore_flag = 0xFF;

void put_msp_place(const Fix& fix, MspSensorGps& to) {
    to.longitude.set(fix.position.longitude.deg());
    to.latitude.set(fix.position.latitude.deg());
    to.msl_altitude.set(msl_height(fix));
}

void put_msp_estimates(const Fix& fix, MspSensorGps& to) {
    to.h_acc.set(fix.horizontal_accuracy.value());
    to.v_acc.set(fix.vertical_accuracy.value());
    to.speed_acc.set(fix.speed_accuracy.value());
    if (fix.dop.hdop > 0) to.dop.set(fix.dop.hdop);
    to.vel_north.set(fix.velocity.north);
    to.vel_east.set(fix.velocity.east);
    to.vel_down.set(fix.velocity.down);
}

void put_msp_clock(const NavigationState& state, MspSensorGps& to) {
    const UtcTime utc = reported_utc(state);
    to.year = static_cast<std::uint16_t>(utc.year);
    to.month = static_cast<std::uint8_t>(utc.month);
    to.day = static_cast<std::uint8_t>(utc.day);
    to.hour = static_cast<std::uint8_t>(utc.hour);
    to.minute = static_cast<std::uint8_t>(utc.minute);
    to.second = static_cast<std::uint8_t>(utc.second);
}

void put_mavlink_place(const Fix& fix, MavlinkGpsInput& to) {
    to.lat.set(fix.position.latitude.deg());
    to.lon.set(fix.position.longitude.deg());
    to.alt.set(msl_height(fix));
    to.ignore_flags &= static_cast<std::uint16_t>(~ignore_alt);
}

void put_mavlink_estimates(const Fix& fix, MavlinkGpsInput& to) {
    if (fix.dop.hdop > 0)
        to.hdop.set(fix.dop.hdop);
    else
        to.ignore_flags |= ignore_hdop;
    if (fix.dop.vdop > 0)
        to.vdop.set(fix.dop.vdop);
    else
        to.ignore_flags |= ignore_vdop;
    to.vn.set(fix.velocity.north);
    to.ve.set(fix.velocity.east);
    to.vd.set(fix.velocity.down);
    to.speed_accuracy.set(fix.speed_accuracy.value());
    to.horiz_accuracy.set(fix.horizontal_accuracy.value());
    to.vert_accuracy.set(fix.vertical_accuracy.value());
}

}  // namespace

MspSensorGps msp_sensor_gps(const NavigationState& state) {
    const Fix& fix = state.epoch.fix;
    MspSensorGps message;
    // Betaflight takes any number but 0 for a fix; to ArduPilot and iNav 0 is none, too.
    if (has_solution(state)) message.fix_type = autopilot_fix_type(state);
    message.satellites = reported_satellites(fix);
    const WeekAndTow stamp = gps_stamp(state);
    if (state.time.date) message.gps_week.set(static_cast<double>(stamp.week));
    if (state.time.time) message.ms_tow = whole_milliseconds(stamp);
    if (state.time.time && state.time.date) put_msp_clock(state, message);
    if (has_place(state)) put_msp_place(fix, message);
    if (!has_solution(state)) return message;
    put_msp_estimates(fix, message);
    if (state.course) message.course.set(state.course->deg());
    if (const auto attitude = pair_attitude(state)) message.true_yaw.set(attitude->heading_deg);
    return message;
}

MspSetRawGps msp_set_raw_gps(const NavigationState& state) {
    const Fix& fix = state.epoch.fix;
    MspSetRawGps message;
    message.satellites = reported_satellites(fix);
    if (!has_place(state)) return message;
    message.latitude.set(fix.position.latitude.deg());
    message.longitude.set(fix.position.longitude.deg());
    message.altitude.set(msl_height(fix));
    if (!has_solution(state)) return message;
    message.fix = 1;
    message.speed.set(fix.speed.value());
    return message;
}

MavlinkGpsInput mavlink_gps_input(const NavigationState& state) {
    const Fix& fix = state.epoch.fix;
    MavlinkGpsInput message;
    message.fix_type = autopilot_fix_type(state);
    message.satellites_visible = reported_satellites(fix);
    const WeekAndTow stamp = gps_stamp(state);
    if (state.time.date) message.time_week.set(static_cast<double>(stamp.week));
    if (state.time.time) message.time_week_ms = whole_milliseconds(stamp);
    if (state.time.time && state.time.date) message.time_usec = posix_microseconds(fix.time, fix.leap_seconds);
    message.ignore_flags = every_ignore_flag;
    if (has_place(state)) put_mavlink_place(fix, message);
    if (!has_solution(state)) return message;
    message.ignore_flags = 0;
    put_mavlink_estimates(fix, message);
    if (const auto attitude = pair_attitude(state)) {
        message.yaw.set(attitude->heading_deg);
        if (message.yaw == 0) message.yaw = 36000;
    }
    return message;
}

// A ground station takes a component for alive by a heartbeat a second, whatever the rate of its data.
std::vector<Bytes> mavlink_messages(const NavigationState& state, MavlinkSent& sent) {
    MavlinkSource source;
    std::vector<Bytes> frames;
    const auto add = [&](const auto& message) {
        source.sequence = sent.sequence++;
        frames.push_back(encode_mavlink(source, message));
    };
    const auto second = static_cast<std::int64_t>(std::floor(state.since_boot.value()));
    if (std::exchange(sent.beat_second, second) != second) add(MavlinkHeartbeat{});
    add(mavlink_gps_input(state));
    return frames;
}

}  // namespace skyloop::firmware
