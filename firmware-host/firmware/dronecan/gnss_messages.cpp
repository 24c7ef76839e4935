#include "firmware/dronecan/gnss_messages.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>

#include "firmware/messages/field_values.hpp"

namespace skyloop::firmware {
namespace {

constexpr std::uint64_t utc_standard_code = 2;
constexpr float not_known = std::numeric_limits<float>::quiet_NaN();
constexpr double half_limit = 65519;  // beyond it half precision is infinite

std::uint64_t microseconds(Seconds time) {
    return static_cast<std::uint64_t>(std::max(0LL, std::llround(time.value() * 1e6)));
}

void put_times(const NavigationState& state, GpsTime now, DronecanFix2& to) {
    const Fix& fix = state.epoch.fix;
    const Seconds age = difference(now, fix.time);
    if (!state.time.time || !state.time.date) {
        to.timestamp = microseconds(state.since_boot + age);
        return;
    }
    to.gnss_timestamp = posix_microseconds(fix.time, fix.leap_seconds);
    to.timestamp = to.gnss_timestamp + microseconds(age);
    to.time_standard = utc_standard_code;
    if (state.time.leap_seconds) to.leap_seconds = static_cast<std::uint64_t>(std::clamp(fix.leap_seconds, 0, 255));
}

void put_kind(const Fix& fix, DronecanFix2& to) {
    constexpr std::uint64_t flat = 2, full = 3, differential = 1, rtk = 2;
    to.status = fix.type == FixType::fix_2d ? flat : full;
    if (fix.type == FixType::dgnss) {
        to.mode = differential;
        to.sub_mode = fix.sbas_source ? 1 : 0;
    } else if (fix.type == FixType::rtk_float || fix.type == FixType::rtk_fixed) {
        to.mode = rtk;
        to.sub_mode = fix.type == FixType::rtk_fixed ? 1 : 0;
    }
}

float variance(bool known, double deviation) {
    const double square = deviation * deviation;
    return known && square < half_limit ? static_cast<float>(square) : not_known;
}

void put_accuracies(const NavigationState& state, DronecanFix2& to) {
    const bool known = estimates_known(state);
    const Fix& fix = state.epoch.fix;
    const float horizontal = variance(known, fix.horizontal_accuracy.value());
    const float vertical = variance(known, fix.vertical_accuracy.value());
    const float speed = variance(known, fix.speed_accuracy.value());
    to.covariance = {horizontal, horizontal, vertical, speed, speed, speed};
}

float dop_value(const Fix& fix, double value) {
    return static_cast<float>(has_dops(fix) && value > 0 ? std::min(value, unknown_dop) : unknown_dop);
}

}  // namespace

DronecanFix2 dronecan_fix(const NavigationState& state, GpsTime now) {
    const Fix& fix = state.epoch.fix;
    DronecanFix2 message;
    put_times(state, now, message);
    if (has_place(state)) {
        message.latitude.set(fix.position.latitude.deg());
        message.longitude.set(fix.position.longitude.deg());
        message.height.set(fix.position.height.above_ellipsoid.value());
        message.msl_height.set(msl_height(fix));
    }
    message.satellites.set(fix.satellites_used());
    put_accuracies(state, message);
    message.pdop = dop_value(fix, fix.dop.pdop);
    if (has_solution(state)) {
        put_kind(fix, message);
        message.velocity[0] = static_cast<float>(fix.velocity.north);
        message.velocity[1] = static_cast<float>(fix.velocity.east);
        message.velocity[2] = static_cast<float>(fix.velocity.down);
    } else if (fix.type == FixType::time_only) {
        message.status = 1;
    }
    return message;
}

DronecanAuxiliary dronecan_auxiliary(const NavigationState& state) {
    const Fix& fix = state.epoch.fix;
    DronecanAuxiliary message;
    message.gdop = dop_value(fix, fix.dop.gdop);
    message.pdop = dop_value(fix, fix.dop.pdop);
    message.hdop = dop_value(fix, fix.dop.hdop);
    message.vdop = dop_value(fix, fix.dop.vdop);
    message.tdop = dop_value(fix, fix.dop.tdop);
    message.ndop = dop_value(fix, fix.dop.ndop);
    message.edop = dop_value(fix, fix.dop.edop);
    message.visible.set(static_cast<double>(fix.satellites.size()));
    message.used.set(fix.satellites_used());
    return message;
}

namespace {

// 1 σ of the heading: of what lies across the vector.
double heading_deviation(const RelativePosition& pair) {
    return std::atan2(pair.deviation.value(), std::hypot(pair.north_m, pair.east_m));
}

}  // namespace

std::optional<DronecanHeading> dronecan_heading(const NavigationState& state) {
    const auto attitude = pair_attitude(state);
    if (!attitude) return std::nullopt;
    DronecanHeading message;
    message.heading_valid = 1;
    message.heading = static_cast<float>(attitude->heading_deg * std::numbers::pi / 180);
    message.accuracy = static_cast<float>(heading_deviation(*state.epoch.relative));
    message.accuracy_valid = message.accuracy > 0 ? 1 : 0;
    return message;
}

std::optional<DronecanRelPosHeading> dronecan_relative_heading(const NavigationState& state) {
    const auto attitude = pair_attitude(state);
    if (!attitude) return std::nullopt;
    const RelativePosition& pair = *state.epoch.relative;
    DronecanRelPosHeading message;
    message.timestamp = microseconds(state.since_boot);
    message.heading = static_cast<float>(attitude->heading_deg);
    message.accuracy = static_cast<float>(heading_deviation(pair) * 180 / std::numbers::pi);
    message.accuracy_available = message.accuracy > 0 ? 1 : 0;
    message.distance = static_cast<float>(std::hypot(pair.north_m, pair.east_m, pair.down_m));
    message.down = static_cast<float>(pair.down_m);
    return message;
}

}  // namespace skyloop::firmware
