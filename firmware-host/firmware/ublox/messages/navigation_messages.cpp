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

constexpr int newest_without_vehicle = 7;            // generation of u-blox
constexpr std::int32_t unknown_h_msl = -17000;       // mm, the geoid at 0° N 0° E
constexpr std::uint32_t unknown_v_acc = 3750000128;  // mm
constexpr double unknown_speed_acc_mps = 20;         // m/s
constexpr double unknown_course_accuracy_deg = 180;
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

template <class Message>
void put_place(const NavigationState& state, Message& m) {
    m.h_msl = unknown_h_msl;
    m.h_acc = unknown_accuracy;
    m.v_acc = unknown_v_acc;
    if (!state.ever_had_fix) return;
    const Fix& fix = state.epoch.fix;
    const double height = fix.position.height.above_ellipsoid.value();
    m.lon.set(fix.position.longitude.deg());
    m.lat.set(fix.position.latitude.deg());
    m.height.set(height);
    m.h_msl.set(height - fix.geoid_undulation.value());
    if (!estimates_known(state)) return;
    m.h_acc.set(fix.horizontal_accuracy.value());
    m.v_acc.set(fix.vertical_accuracy.value());
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

template <class Field>
void put_speed_accuracy(const NavigationState& state, Field& accuracy) {
    accuracy.set(estimates_known(state) ? state.epoch.fix.speed_accuracy.value() : unknown_speed_acc_mps);
}

void put_motion(const NavigationState& state, NavPvt& pvt) {
    const Fix& fix = state.epoch.fix;
    put_speed_accuracy(state, pvt.s_acc);
    pvt.head_acc.set(unknown_course_accuracy_deg);
    if (!estimates_known(state)) return;
    pvt.vel_n.set(fix.velocity.north);
    pvt.vel_e.set(fix.velocity.east);
    pvt.vel_d.set(fix.velocity.down);
    pvt.g_speed.set(fix.speed.value());
    pvt.head_mot = course_field(state);
    pvt.head_acc.set(reported_course_accuracy_deg(state));
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
    put_place(state, pvt);
    put_motion(state, pvt);
    pvt.p_dop.set(reported_dop(fix.dop.pdop, has_dops(fix)));
    const bool invalid = !state.ever_had_fix && context.board.identity.generation >= 9;
    pvt.flags3 = static_cast<std::uint16_t>((invalid ? 1 : 0) | correction_age_code(state.corrections.age) << 1);
    if (context.board.identity.generation <= newest_without_vehicle) return pvt;
    pvt.reserved = pvt_reserved;
    pvt.vehicle = NavPvtVehicle{pvt.head_mot.raw, 0, 0};
    return pvt;
}

NavPosllh navigation_posllh(const ReportContext& context) {
    auto m = stamped<NavPosllh>(context);
    put_place(context.state, m);
    return m;
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
    put_split(fix.position.longitude.deg(), m.lon, m.lon_hp);
    put_split(fix.position.latitude.deg(), m.lat, m.lat_hp);
    put_split(height, m.height, m.height_hp);
    put_split(height - fix.geoid_undulation.value(), m.h_msl, m.h_msl_hp);
    if (!estimates_known(state)) return m;
    m.h_acc.set(fix.horizontal_accuracy.value());
    m.v_acc.set(fix.vertical_accuracy.value());
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

// 1 σ in three dimensions.
template <class Field>
void put_place_accuracy(const NavigationState& state, Field& accuracy) {
    accuracy = unknown_accuracy;
    if (!estimates_known(state)) return;
    const Fix& fix = state.epoch.fix;
    accuracy.set(std::hypot(fix.horizontal_accuracy.value(), fix.vertical_accuracy.value()));
}

template <class Field>
void put_vector(const Eigen::Vector3d& values, Field& field) {
    for (std::size_t i = 0; i < 3; ++i)
        field.set(i, values[static_cast<Eigen::Index>(i)]);
}

NavPosecef navigation_posecef(const ReportContext& context) {
    auto m = stamped<NavPosecef>(context);
    put_vector(earth_fixed(context.state), m.ecef);
    put_place_accuracy(context.state, m.p_acc);
    return m;
}

NavHpposecef navigation_hpposecef(const ReportContext& context) {
    auto m = stamped<NavHpposecef>(context);
    put_split(earth_fixed(context.state), m.ecef, m.ecef_hp);
    m.flags = place_is_valid(context) ? 0 : 1;
    put_place_accuracy(context.state, m.p_acc);
    return m;
}

NavVelecef navigation_velecef(const ReportContext& context) {
    auto m = stamped<NavVelecef>(context);
    put_vector(earth_fixed_velocity(context.state), m.ecef_v);
    put_speed_accuracy(context.state, m.s_acc);
    return m;
}

NavVelned navigation_velned(const ReportContext& context) {
    const NavigationState& state = context.state;
    auto m = stamped<NavVelned>(context);
    put_speed_accuracy(state, m.s_acc);
    m.c_acc.set(unknown_course_accuracy_deg);
    if (!estimates_known(state)) return m;
    const Fix& fix = state.epoch.fix;
    m.vel_n.set(fix.velocity.north);
    m.vel_e.set(fix.velocity.east);
    m.vel_d.set(fix.velocity.down);
    m.speed.set(std::hypot(fix.velocity.north, fix.velocity.east, fix.velocity.down));
    m.g_speed.set(fix.speed.value());
    m.heading = course_field(state);
    m.c_acc.set(reported_course_accuracy_deg(state));
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
    put_vector(earth_fixed(state), m.ecef);
    put_place_accuracy(state, m.p_acc);
    put_vector(earth_fixed_velocity(state), m.ecef_v);
    put_speed_accuracy(state, m.s_acc);
    m.p_dop.set(reported_dop(state.epoch.fix.dop.pdop, has_dops(state.epoch.fix)));
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
    if (state.time_to_first_fix) m.ttff.set(state.time_to_first_fix->value());
    m.msss.set(state.since_start.value());
    return m;
}

NavDop navigation_dop(const ReportContext& context) {
    const Fix& fix = context.state.epoch.fix;
    const bool place = has_dops(fix), time = place || fix.type == FixType::time_only;
    auto m = stamped<NavDop>(context);
    m.g_dop.set(reported_dop(place ? fix.dop.gdop : fix.dop.tdop, time));  // of the time alone both are one
    m.p_dop.set(reported_dop(fix.dop.pdop, place));
    m.t_dop.set(reported_dop(fix.dop.tdop, time));
    m.v_dop.set(reported_dop(fix.dop.vdop, place));
    m.h_dop.set(reported_dop(fix.dop.hdop, place));
    m.n_dop.set(reported_dop(fix.dop.ndop, place));
    m.e_dop.set(reported_dop(fix.dop.edop, place));
    return m;
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
