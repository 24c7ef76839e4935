#include "firmware/casic/messages.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "base/geo/local_frame.hpp"
#include "firmware/messages/field_values.hpp"
#include "firmware/messages/make_message.hpp"
#include "receiver/protocol/nmea_sentence.hpp"

namespace skyloop::firmware {
namespace {

std::uint32_t run_time_ms(const NavigationState& state) {
    constexpr double thousandths = 1000;
    return nearest<std::uint32_t>(state.since_boot.value() * thousandths);
}

std::uint8_t casic_validity(const NavigationState& state) {
    const Fix& fix = state.epoch.fix;
    if (!fix.has_position() || !state.fix_ok) return casic_invalid;
    if (fix.type == FixType::dead_reckoning) return casic_reckoned;
    return fix.type == FixType::fix_2d ? casic_2d : casic_3d;
}

float squared(double deviation) { return static_cast<float>(deviation * deviation); }

// What NAV-SOL and NAV-PV tell of the satellites.
template <class Message>
void put_satellite_counts(const Fix& fix, Message& m) {
    for (const SatelliteStatus& s : fix.satellites) {
        if (!s.used) continue;
        ++m.num_sv;
        if (s.id.constellation == Constellation::gps) ++m.num_gps;
        if (s.id.constellation == Constellation::beidou) ++m.num_bds;
        if (s.id.constellation == Constellation::glonass) ++m.num_glo;
    }
    m.systems = static_cast<std::uint8_t>((m.num_gps > 0 ? 1 : 0) | (m.num_bds > 0 ? 2 : 0) | (m.num_glo > 0 ? 4 : 0));
}

template <class Message>
void put_casic_solution(const ReportContext& context, Message& m) {
    const NavigationState& state = context.state;
    m.run_time = run_time_ms(state);
    m.pos_valid = m.vel_valid = casic_validity(state);
    if (has_solution(state)) put_satellite_counts(state.epoch.fix, m);
    m.p_dop = static_cast<float>(reported_dop(state.epoch.fix.dop.pdop, has_dops(state.epoch.fix)));
}

template <class Message>
Message satellites_of(Constellation system, const ReportContext& context) {
    const NavigationState& state = context.state;
    Message m;
    m.run_time = run_time_ms(state);
    m.system = Message::message_id.id & 0x0F;
    std::uint8_t channel = 0;
    for (const SatelliteStatus& s : sorted_satellites(state.epoch.fix)) {
        if (s.id.constellation != system) continue;
        constexpr std::uint8_t by_ephemeris = 0xC0, in_use = 0x01, ranged = 0x63;  // as captured
        const SkyFields sky = sky_fields(s, state);
        CasicSatellite item;
        item.channel = s.cn0 ? channel++ : std::numeric_limits<std::uint8_t>::max();
        item.sv = static_cast<std::uint8_t>(s.id.number);
        item.flags = static_cast<std::uint8_t>((s.has_ephemeris ? by_ephemeris : 0) | (s.used ? in_use : 0));
        item.quality = s.cn0 ? ranged : std::uint8_t{0};
        item.cno = cn0_field(s.cn0);
        item.elevation = std::max<std::int8_t>(sky.elevation, -90);
        item.azimuth = sky.azimuth;
        item.residual = s.used && s.residual ? static_cast<float>(s.residual->value()) : 0.0F;
        m.used = static_cast<std::uint8_t>(m.used + (s.used ? 1 : 0));
        m.satellites.push_back(item);
    }
    return m;
}

}  // namespace

CasicNavDop casic_dop(const ReportContext& context) {
    const Fix& fix = context.state.epoch.fix;
    const bool known = has_dops(fix);
    const auto dop = [&](double value) { return static_cast<float>(reported_dop(value, known)); };
    CasicNavDop m;
    m.run_time = run_time_ms(context.state);
    m.p_dop = dop(fix.dop.pdop);
    m.h_dop = dop(fix.dop.hdop);
    m.v_dop = dop(fix.dop.vdop);
    m.n_dop = dop(fix.dop.ndop);
    m.e_dop = dop(fix.dop.edop);
    m.t_dop = dop(fix.dop.tdop);
    return m;
}

CasicNavSol casic_solution(const ReportContext& context) {
    const NavigationState& state = context.state;
    const Fix& fix = state.epoch.fix;
    CasicNavSol m;
    put_casic_solution(context, m);
    if (state.time.time && state.time.date) {
        const WeekAndTow stamp = gps_stamp(state);
        m.week = static_cast<std::uint16_t>(stamp.week);
        m.tow = std::chrono::duration<double>(stamp.tow).count();
    }
    if (!has_place(state)) return m;
    const Displacement<Enu> local(fix.velocity.east, fix.velocity.north, -fix.velocity.down);
    const Eigen::Vector3d place = to_ecef(fix.position).vector();
    const Eigen::Vector3d velocity = LocalFrame(fix.position).to_ecef(local).vector();
    for (std::size_t i = 0; i < 3; ++i) {
        m.ecef[i] = place[static_cast<Eigen::Index>(i)];
        m.velocity[i] = static_cast<float>(velocity[static_cast<Eigen::Index>(i)]);
    }
    m.p_variance = squared(std::hypot(fix.horizontal_accuracy.value(), fix.vertical_accuracy.value()));
    m.s_variance = squared(fix.speed_accuracy.value());
    return m;
}

CasicNavPv casic_position(const ReportContext& context) {
    const NavigationState& state = context.state;
    const Fix& fix = state.epoch.fix;
    CasicNavPv m;
    put_casic_solution(context, m);
    m.c_var = casic_unknown_heading_variance;
    if (!has_place(state)) return m;
    m.lon = fix.position.longitude.deg();
    m.lat = fix.position.latitude.deg();
    m.height = static_cast<float>(fix.position.height.above_ellipsoid.value());
    m.geoid = static_cast<float>(fix.geoid_undulation.value());
    m.h_var = squared(fix.horizontal_accuracy.value());
    m.v_var = squared(fix.vertical_accuracy.value());
    if (!has_solution(state)) return m;
    m.vel_n = static_cast<float>(fix.velocity.north);
    m.vel_e = static_cast<float>(fix.velocity.east);
    m.vel_u = static_cast<float>(-fix.velocity.down);
    m.speed_3d = static_cast<float>(std::hypot(fix.velocity.north, fix.velocity.east, fix.velocity.down));
    m.speed = static_cast<float>(fix.speed.value());
    m.course = static_cast<float>(state.course.value_or(fix.course).deg());
    m.s_var = squared(fix.speed_accuracy.value());
    if (!state.course_is_frozen && state.course) m.c_var = squared(reported_course_accuracy_deg(state));
    return m;
}

CasicNavTimeutc casic_time(const ReportContext& context) {
    const NavigationState& state = context.state;
    CasicNavTimeutc m;
    m.run_time = run_time_ms(state);
    m.valid = static_cast<std::uint8_t>((state.time.time ? 1 : 0) | (state.time.date ? 2 : 0) |
                                        (state.time.leap_seconds ? 4 : 0));
    if (!state.time.time) return m;
    constexpr double light_mps = 299'792'458.0;
    constexpr std::uint32_t ms_ns = 1'000'000;
    constexpr std::uint8_t by_several = 3;
    const UtcTime utc = reported_utc(state);
    m.t_variance = squared(state.time.accuracy.value() * light_mps);
    m.millisecond = static_cast<std::uint16_t>(utc.nanosecond / ms_ns);
    m.hour = static_cast<std::uint8_t>(utc.hour);
    m.minute = static_cast<std::uint8_t>(utc.minute);
    m.second = static_cast<std::uint8_t>(utc.second);
    if (!state.time.date) return m;
    m.year = static_cast<std::uint16_t>(utc.year);
    m.month = static_cast<std::uint8_t>(utc.month);
    m.day = static_cast<std::uint8_t>(utc.day);
    m.date_valid = by_several;
    return m;
}

std::optional<Bytes> casic_frame(CasicMessageId message, const ReportContext& context) {
    if (message == CasicNavDop::message_id) return encode_casic(casic_dop(context));
    if (message == CasicNavSol::message_id) return encode_casic(casic_solution(context));
    if (message == CasicNavPv::message_id) return encode_casic(casic_position(context));
    if (message == CasicNavTimeutc::message_id) return encode_casic(casic_time(context));
    if (message == CasicGpsSatellites::message_id)
        return encode_casic(satellites_of<CasicGpsSatellites>(Constellation::gps, context));
    if (message == CasicBeidouSatellites::message_id)
        return encode_casic(satellites_of<CasicBeidouSatellites>(Constellation::beidou, context));
    if (message == CasicGlonassSatellites::message_id)
        return encode_casic(satellites_of<CasicGlonassSatellites>(Constellation::glonass, context));
    return std::nullopt;
}

Bytes casic_antenna_text(const ReportContext& context) {
    const AntennaStatus antenna = context.state.monitors.antenna;
    const std::string_view word = antenna == AntennaStatus::open            ? "OPEN"
                                  : antenna == AntennaStatus::short_circuit ? "SHORT"
                                                                            : "OK";
    return to_bytes(Sentence("GPTXT,01,01,01,ANTENNA " + std::string(word)).finish());
}

}  // namespace skyloop::firmware
