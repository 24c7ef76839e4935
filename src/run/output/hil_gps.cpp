#include "run/output/hil_gps.hpp"

#include <algorithm>

#include "firmware/messages/other_protocols.hpp"
#include "firmware/messages/reported_fix.hpp"

namespace skyloop {
namespace {

constexpr std::uint8_t fix_type_3d = 3;

// A value that is known is none of 65535, which means that it is not.
std::uint16_t known_hundredths(double value) {
    constexpr std::uint16_t most = 0xFFFE;
    return std::min(most, firmware::field<std::uint16_t>(value * 100));
}

void put_accuracy(const Fix& fix, HilGpsAccuracy accuracy, MavlinkHilGps& to) {
    if (accuracy == HilGpsAccuracy::px4_cm) {
        to.eph = known_hundredths(fix.horizontal_accuracy.value());
        to.epv = known_hundredths(fix.vertical_accuracy.value());
        return;
    }
    if (fix.dop.hdop > 0) to.eph = known_hundredths(fix.dop.hdop);
    if (fix.dop.vdop > 0) to.epv = known_hundredths(fix.dop.vdop);
}

}  // namespace

MavlinkHilGps mavlink_hil_gps(const firmware::NavigationState& state, HilGpsAccuracy accuracy) {
    const MavlinkGpsInput known = firmware::mavlink_gps_input(state);
    const Fix& fix = state.epoch.fix;
    MavlinkHilGps message;
    message.time_usec = known.time_usec;
    message.fix_type = std::min(known.fix_type, fix_type_3d);
    message.satellites_visible = known.satellites_visible;
    message.lat = known.lat;
    message.lon = known.lon;
    if (firmware::has_place(state)) message.alt = firmware::field<std::int32_t>(firmware::msl_height(fix) * 1000);
    if (!firmware::has_solution(state)) return message;
    put_accuracy(fix, accuracy, message);
    message.vel = known_hundredths(fix.speed.value());
    message.vn = firmware::field<std::int16_t>(fix.velocity.north * 100);
    message.ve = firmware::field<std::int16_t>(fix.velocity.east * 100);
    message.vd = firmware::field<std::int16_t>(fix.velocity.down * 100);
    constexpr std::uint16_t full_turn = 36000;
    if (state.course) message.cog = known_hundredths(state.course->deg()) % full_turn;
    message.yaw = known.yaw;
    return message;
}

}  // namespace skyloop
