// NAV messages of the solution (RECEIVER.md 3.1; without a fix 4.10).
#include <array>
#include <cmath>

#include "base/geo/local_frame.hpp"
#include "firmware/core/base_station.hpp"
#include "firmware/messages/field_values.hpp"
#include "firmware/messages/make_message.hpp"
#include "receiver/protocol/ubx_nav.hpp"

namespace skyloop::firmware {
namespace {

constexpr int newest_without_vehicle = 7;                                   // generation of u-blox
constexpr std::int32_t unknown_h_msl = -17000;                              // mm, the geoid at 0° N 0° E
constexpr std::uint32_t unknown_v_acc = 3750000128, unknown_s_acc = 20000;  // mm, mm/s
constexpr std::uint32_t unknown_heading = 18000000;                         // 1e-5 deg
// What undocumented bytes are on captured receivers.
constexpr std::uint32_t pvt_reserved = 0x2F56405C, sol_reserved = 0x0003644A;

// RECEIVER.md 3.1, NAV-PVT flags3.
std::uint8_t correction_age_code(const std::optional<Seconds>& age) {
    if (!age) return 0;
    constexpr std::array<double, 11> borders{1, 2, 5, 10, 15, 20, 30, 45, 60, 90, 120};
    std::uint8_t code = 1;
    for (const double border : borders)
        if (age->value() >= border) ++code;
    return code;
}

struct PlaceFields {
    std::int32_t lon = 0, lat = 0, height = 0, h_msl = unknown_h_msl;
    std::uint32_t h_acc = unknown_accuracy, v_acc = unknown_v_acc;
};

PlaceFields place_fields(const NavigationState& state) {
    if (!state.ever_had_fix) return {};
    const Fix& fix = state.epoch.fix;
    const double height = fix.position.height.above_ellipsoid.value();
    PlaceFields place{field<std::int32_t>(fix.position.longitude.deg() * 1e7),
                      field<std::int32_t>(fix.position.latitude.deg() * 1e7), field<std::int32_t>(height * 1e3),
                      field<std::int32_t>((height - fix.geoid_undulation.value()) * 1e3)};
    if (!estimates_known(state)) return place;
    place.h_acc = field<std::uint32_t>(fix.horizontal_accuracy.value() * 1e3);
    place.v_acc = field<std::uint32_t>(fix.vertical_accuracy.value() * 1e3);
    return place;
}

std::uint8_t pvt_valid(const ReportContext& context) {
    const TimeKnowledge& time = context.state.time;
    const bool resolved = time.date && time.time && time.leap_seconds;
    return static_cast<std::uint8_t>((time.date ? 1 : 0) | (time.time ? 2 : 0) | (resolved ? 4 : 0) |
                                     utc_standard(context) << 4);
}

// Bits 0 to 4 stand in no document; captured receivers say 10 with a solution and 4 without (RECEIVER.md 3.1).
std::uint8_t pvt_flags2(const ReportContext& context) {
    if (context.board.identity.generation <= newest_without_vehicle) return 0;
    const int undocumented = context.state.epoch.fix.has_position() ? 0x0A : 0x04;
    return static_cast<std::uint8_t>(undocumented | 0x20 | (context.state.time.confirmed ? 0xC0 : 0));
}

void put_time(const ReportContext& context, NavPvt& pvt) {
    const UtcFields now = utc_fields(reported_time(context));
    pvt.year = static_cast<std::uint16_t>(now.utc.year);
    pvt.month = static_cast<std::uint8_t>(now.utc.month);
    pvt.day = static_cast<std::uint8_t>(now.utc.day);
    pvt.hour = static_cast<std::uint8_t>(now.utc.hour);
    pvt.minute = static_cast<std::uint8_t>(now.utc.minute);
    pvt.second = static_cast<std::uint8_t>(now.utc.second);
    pvt.valid = pvt_valid(context);
    pvt.t_acc = time_accuracy_ns(context.state);
    pvt.nano = now.nano;
}

void put_motion(const NavigationState& state, NavPvt& pvt) {
    const Fix& fix = state.epoch.fix;
    pvt.s_acc = unknown_s_acc;
    pvt.head_acc = unknown_heading;
    if (!estimates_known(state)) return;
    pvt.vel_n = field<std::int32_t>(fix.velocity.north * 1e3);
    pvt.vel_e = field<std::int32_t>(fix.velocity.east * 1e3);
    pvt.vel_d = field<std::int32_t>(fix.velocity.down * 1e3);
    pvt.g_speed = field<std::int32_t>(fix.speed.value() * 1e3);
    pvt.head_mot = course_field(state);
    pvt.s_acc = field<std::uint32_t>(fix.speed_accuracy.value() * 1e3);
    pvt.head_acc = heading_accuracy_field(state);
}

NavPvt navigation_pvt(const ReportContext& context) {
    const NavigationState& state = context.state;
    const Fix& fix = state.epoch.fix;
    auto pvt = stamped<NavPvt>(context);
    put_time(context, pvt);
    pvt.fix_type = fix_type_code(fix);
    pvt.flags = static_cast<std::uint8_t>((state.fix_ok ? 1 : 0) | (is_differential(fix) ? 2 : 0) |
                                          static_cast<int>(state.power_save) << 2 | carrier_solution(fix) << 6);
    pvt.flags2 = pvt_flags2(context);
    pvt.num_sv = used_satellites(fix);
    const PlaceFields place = place_fields(state);
    pvt.lon = place.lon;
    pvt.lat = place.lat;
    pvt.height = place.height;
    pvt.h_msl = place.h_msl;
    pvt.h_acc = place.h_acc;
    pvt.v_acc = place.v_acc;
    put_motion(state, pvt);
    pvt.p_dop = dop_field(fix.dop.pdop, has_dops(fix));
    const bool invalid = !state.ever_had_fix && context.board.identity.generation >= 9;
    pvt.flags3 = static_cast<std::uint16_t>((invalid ? 1 : 0) | correction_age_code(state.corrections.age) << 1);
    if (context.board.identity.generation <= newest_without_vehicle) return pvt;
    pvt.reserved = pvt_reserved;
    pvt.vehicle = NavPvtVehicle{pvt.head_mot.raw, 0, 0};
    return pvt;
}

NavPosllh navigation_posllh(const ReportContext& context) {
    const PlaceFields place = place_fields(context.state);
    return {epoch_time(reported_time(context).time).i_tow,
            place.lon,
            place.lat,
            place.height,
            place.h_msl,
            place.h_acc,
            place.v_acc};
}

// A base that solves for the time alone knows its place all the same.
bool place_is_valid(const ReportContext& context) {
    const Fix& fix = context.state.epoch.fix;
    return fix.has_position() ||
           (fix.type == FixType::time_only && base_place(context.config.place, context.state.survey));
}

NavHpposllh navigation_hpposllh(const ReportContext& context) {
    const NavigationState& state = context.state;
    const Fix& fix = state.epoch.fix;
    auto m = stamped<NavHpposllh>(context);
    m.flags = place_is_valid(context) ? 0 : 1;
    m.h_msl = unknown_h_msl;
    m.h_acc = m.v_acc = unknown_accuracy;
    if (!state.ever_had_fix) return m;
    const double height = fix.position.height.above_ellipsoid.value();
    put_split(fix.position.longitude.deg() * 1e9, 100, m.lon, m.lon_hp);
    put_split(fix.position.latitude.deg() * 1e9, 100, m.lat, m.lat_hp);
    put_split(height * 1e4, 10, m.height, m.height_hp);
    put_split((height - fix.geoid_undulation.value()) * 1e4, 10, m.h_msl, m.h_msl_hp);
    if (!estimates_known(state)) return m;
    m.h_acc = field<std::uint32_t>(fix.horizontal_accuracy.value() * 1e4);
    m.v_acc = field<std::uint32_t>(fix.vertical_accuracy.value() * 1e4);
    return m;
}

// The position in the Earth-fixed frame, metres; without any that of 0° N 0° E, as captured receivers say.
Eigen::Vector3d earth_fixed(const NavigationState& state) {
    return to_ecef(state.ever_had_fix ? state.epoch.fix.position : Geodetic{}).vector();
}

Eigen::Vector3d earth_fixed_velocity(const NavigationState& state) {
    if (!estimates_known(state)) return Eigen::Vector3d::Zero();
    const Fix& fix = state.epoch.fix;
    const Velocity<Enu> local(fix.velocity.east, fix.velocity.north, -fix.velocity.down);
    return LocalFrame(fix.position).to_ecef(local).vector();
}

// 1 σ in three dimensions, in units of 1/`per_metre` m.
std::uint32_t place_accuracy(const NavigationState& state, double per_metre) {
    if (!estimates_known(state)) return unknown_accuracy;
    const Fix& fix = state.epoch.fix;
    return field<std::uint32_t>(std::hypot(fix.horizontal_accuracy.value(), fix.vertical_accuracy.value()) * per_metre);
}

std::uint32_t speed_accuracy_cm(const NavigationState& state) {
    return estimates_known(state) ? field<std::uint32_t>(state.epoch.fix.speed_accuracy.value() * 1e2)
                                  : unknown_s_acc / 10;
}

std::array<std::int32_t, 3> centimetres(const Eigen::Vector3d& metres) {
    return {field<std::int32_t>(metres.x() * 1e2), field<std::int32_t>(metres.y() * 1e2),
            field<std::int32_t>(metres.z() * 1e2)};
}

NavPosecef navigation_posecef(const ReportContext& context) {
    return {epoch_time(reported_time(context).time).i_tow, centimetres(earth_fixed(context.state)),
            place_accuracy(context.state, 1e2)};
}

NavHpposecef navigation_hpposecef(const ReportContext& context) {
    auto m = stamped<NavHpposecef>(context);
    const Eigen::Vector3d place = earth_fixed(context.state);
    for (std::size_t i = 0; i < 3; ++i)
        put_split(place[static_cast<Eigen::Index>(i)] * 1e4, 100, m.ecef[i], m.ecef_hp[i]);
    m.flags = place_is_valid(context) ? 0 : 1;
    m.p_acc = place_accuracy(context.state, 1e4);
    return m;
}

NavVelecef navigation_velecef(const ReportContext& context) {
    return {epoch_time(reported_time(context).time).i_tow, centimetres(earth_fixed_velocity(context.state)),
            speed_accuracy_cm(context.state)};
}

NavVelned navigation_velned(const ReportContext& context) {
    const NavigationState& state = context.state;
    auto m = stamped<NavVelned>(context);
    m.s_acc = speed_accuracy_cm(state);
    m.c_acc = unknown_heading;
    if (!estimates_known(state)) return m;
    const Fix& fix = state.epoch.fix;
    m.vel_n = field<std::int32_t>(fix.velocity.north * 1e2);
    m.vel_e = field<std::int32_t>(fix.velocity.east * 1e2);
    m.vel_d = field<std::int32_t>(fix.velocity.down * 1e2);
    m.speed = field<std::uint32_t>(std::hypot(fix.velocity.north, fix.velocity.east, fix.velocity.down) * 1e2);
    m.g_speed = field<std::uint32_t>(fix.speed.value() * 1e2);
    m.heading = course_field(state);
    m.c_acc = heading_accuracy_field(state);
    return m;
}

// The upper half of the byte is 0xD on captured M8 (RECEIVER.md 3.1).
std::uint8_t solution_flags(const NavigationState& state) {
    const int known = (state.time.date ? 4 : 0) | (state.time.time ? 8 : 0);
    return static_cast<std::uint8_t>((state.fix_ok ? 1 : 0) | (is_differential(state.epoch.fix) ? 2 : 0) | known);
}

NavSol navigation_sol(const ReportContext& context) {
    const NavigationState& state = context.state;
    const EpochTime now = epoch_time(reported_time(context).time);
    NavSol m;
    m.i_tow = now.i_tow;
    m.f_tow = now.f_tow;
    m.week = week_field<std::int16_t>(state, now.stamp());
    m.gps_fix = fix_type_code(state.epoch.fix);
    m.flags = static_cast<std::uint8_t>(0xD0 | solution_flags(state));
    m.ecef = centimetres(earth_fixed(state));
    m.p_acc = place_accuracy(state, 1e2);
    m.ecef_v = centimetres(earth_fixed_velocity(state));
    m.s_acc = speed_accuracy_cm(state);
    m.p_dop = dop_field(state.epoch.fix.dop.pdop, has_dops(state.epoch.fix));
    m.num_sv = used_satellites(state.epoch.fix);
    m.reserved2 = sol_reserved;
    return m;
}

// The upper half of the byte is 0xD with a fix and 4 without on captured receivers.
NavStatus navigation_status(const ReportContext& context) {
    const NavigationState& state = context.state;
    const Fix& fix = state.epoch.fix;
    const bool solved = fix.type != FixType::none;
    auto m = stamped<NavStatus>(context);
    m.gps_fix = fix_type_code(fix);
    m.flags = static_cast<std::uint8_t>((solved ? 0xD0 : 0x40) | solution_flags(state));
    m.fix_stat = static_cast<std::uint8_t>((is_differential(fix) ? 1 : 0) | (carrier_solution(fix) != 0 ? 2 : 0));
    // psmState counts from acquisition on here, and full power looks like that.
    const int power_save = std::max(0, static_cast<int>(state.power_save) - 2);
    m.flags2 = static_cast<std::uint8_t>(power_save | static_cast<int>(state.monitors.spoofing) << 3 |
                                         carrier_solution(fix) << 6);
    if (state.time_to_first_fix) m.ttff = field<std::uint32_t>(state.time_to_first_fix->value() * 1e3);
    m.msss = field<std::uint32_t>(state.since_start.value() * 1e3);
    return m;
}

NavDop navigation_dop(const ReportContext& context) {
    const Fix& fix = context.state.epoch.fix;
    const bool place = has_dops(fix), time = place || fix.type == FixType::time_only;
    return {epoch_time(reported_time(context).time).i_tow,
            dop_field(place ? fix.dop.gdop : fix.dop.tdop, time),  // of the time alone both are one
            dop_field(fix.dop.pdop, place),
            dop_field(fix.dop.tdop, time),
            dop_field(fix.dop.vdop, place),
            dop_field(fix.dop.hdop, place),
            dop_field(fix.dop.ndop, place),
            dop_field(fix.dop.edop, place)};
}

constexpr UbxMaker solution_makers[] = {
    maker<navigation_pvt>,       maker<navigation_posllh>, maker<navigation_posecef>, maker<navigation_hpposllh>,
    maker<navigation_hpposecef>, maker<navigation_velned>, maker<navigation_velecef>, maker<navigation_sol>,
    maker<navigation_status>,    maker<navigation_dop>};

}  // namespace

std::vector<Bytes> make_solution_message(UbxMessageId message, const ReportContext& context) {
    return made_by(solution_makers, message, context);
}

}  // namespace skyloop::firmware
