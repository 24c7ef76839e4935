// The other NAV messages without satellites: covariances, odometer, base station, fences, end of the epoch (RECEIVER.md
// 3.1, 4.12).
#include <algorithm>
#include <cmath>
#include <numbers>

#include "firmware/core/base_station.hpp"
#include "firmware/core/geofence.hpp"
#include "firmware/core/solution_covariance.hpp"
#include "firmware/core/told_baseline.hpp"
#include "firmware/messages/field_values.hpp"
#include "firmware/messages/make_message.hpp"
#include "receiver/protocol/ubx_nav.hpp"
#include "receiver/protocol/ubx_services.hpp"

namespace skyloop::firmware {
namespace {

// CFG-ANA-USE_ANA (RECEIVER.md 3.5.1).
// A course that is frozen says nothing of the motion.
constexpr double half_turn_deg = 180;

// Of east, north and up the variances and covariances NN, NE, ND, EE, ED, DD.
std::array<float, 6> in_ned(const Eigen::Matrix3d& enu) {
    // Subtracted from 0, which stays without a sign.
    const double north_down = 0 - enu(1, 2), east_down = 0 - enu(0, 2);
    return {static_cast<float>(enu(1, 1)), static_cast<float>(enu(0, 1)), static_cast<float>(north_down),
            static_cast<float>(enu(0, 0)), static_cast<float>(east_down), static_cast<float>(enu(2, 2))};
}

// Variances of errors that are independent, and alike in all level directions.
std::array<float, 6> round_covariance(double level, double vertical) {
    return in_ned(Eigen::Vector3d(level, level, vertical).asDiagonal());
}

// The accuracies alone, alike in all directions: there is no geometry where satellites are not in the solution.
void put_round_covariance(const Fix& fix, NavCov& m) {
    const double level = std::pow(fix.horizontal_accuracy.value(), 2) / 2;
    const double speed = std::pow(fix.speed_accuracy.value(), 2) / 3;
    m.pos_cov = round_covariance(level, std::pow(fix.vertical_accuracy.value(), 2));
    m.vel_cov = round_covariance(speed, speed);
}

// Before the first fix captured receivers give 3750 km and 20 m/s, and call it valid.
NavCov solution_covariance(const ReportContext& context) {
    constexpr double unknown_m = 3750e3, unknown_mps = 20;
    const Fix& fix = context.state.epoch.fix;
    auto m = stamped<NavCov>(context);
    m.pos_cov_valid = m.vel_cov_valid = 1;
    m.pos_cov = round_covariance(unknown_m * unknown_m, unknown_m * unknown_m);
    m.vel_cov = round_covariance(unknown_mps * unknown_mps, unknown_mps * unknown_mps);
    if (!estimates_known(context.state)) return m;
    put_round_covariance(fix, m);
    if (fix.type == FixType::time_only && base_place(context.config.place, context.state.survey)) {
        m.vel_cov.fill(0);
        return m;
    }
    const std::optional<ErrorEllipse> ellipse = error_ellipse(fix);
    if (!fix.has_position() || !ellipse) return m;
    const Eigen::Matrix4d position = position_covariance(fix, *ellipse);
    m.pos_cov = in_ned(position.topLeftCorner<3, 3>());
    const double north = ellipse->north.value(), east = ellipse->east.value();
    const double horizontal = std::hypot(north, east);
    if (!(horizontal > 0) || !(fix.dop.pdop > 0)) return m;
    // Velocity is solved with the same geometry: its error splits as that of the position does.
    const double level = fix.speed_accuracy.value() * std::hypot(fix.dop.ndop, fix.dop.edop) / fix.dop.pdop;
    const double scale = level * level / (horizontal * horizontal);
    const double vertical = fix.speed_accuracy.value() * fix.dop.vdop / fix.dop.pdop;
    const Eigen::Vector3d variances(east * east * scale, north * north * scale, vertical * vertical);
    m.vel_cov = in_ned(velocity_covariance(fix, variances, position(0, 1) * scale));
    return m;
}

NavEell ellipse_message(const ReportContext& context) {
    const Fix& fix = context.state.epoch.fix;
    auto m = stamped<NavEell>(context);
    m.major = m.minor = unknown_accuracy;
    const std::optional<ErrorEllipse> ellipse = error_ellipse(fix);
    if (!fix.has_position() || !ellipse) return m;
    m.orient.set(ellipse->orientation.deg());
    m.major.set(ellipse->semi_major.value());
    m.minor.set(ellipse->semi_minor.value());
    return m;
}

NavOdo odometer(const ReportContext& context) {
    const NavigationState& state = context.state;
    auto m = stamped<NavOdo>(context);
    m.distance.set(state.odometer_m);
    m.total_distance.set(state.odometer_total_m);
    m.distance_std.set(state.odometer_deviation_m);
    return m;
}

// 0 by code, 1 with floating ambiguities, 2 with fixed ones.
std::uint32_t vector_carrier(CorrectionState solution) {
    return solution == CorrectionState::rtk_fixed ? 2 : solution == CorrectionState::rtk_float ? 1 : 0;
}

// Bits: 0 fix ok, 1 differential, 2 vector valid, 3-4 carrier solution, 5 moving base.
std::uint32_t relative_flags(const NavigationState& state, const std::optional<ToldBaseline>& baseline) {
    std::uint32_t flags = state.fix_ok ? 1u : 0u;
    if (!baseline) return flags;
    flags |= is_differential(state.epoch.fix) ? 2u : 0u;
    flags |= 4u | vector_carrier(baseline->solution) << 3 | (baseline->vector.base_moves ? 0x20u : 0u);
    return flags;
}

NavRelposned0 relative_position_m8(const ReportContext& context, const std::optional<ToldBaseline>& baseline) {
    auto m = stamped<NavRelposned0>(context);
    m.flags = relative_flags(context.state, baseline);
    if (!baseline) return m;
    const RelativePosition& relative = baseline->vector;
    m.ref_station_id.set(relative.base_station);
    put_split(Eigen::Vector3d(relative.north_m, relative.east_m, relative.down_m), m.rel_pos, m.rel_pos_hp);
    m.acc.set(0, relative.deviation.value());
    m.acc.set(1, relative.deviation.value());
    m.acc.set(2, relative.down_deviation.value());
    return m;
}

// 1 σ along the vector, m.
double length_deviation(const RelativePosition& r, double length) {
    if (!(length > 0)) return r.deviation.value();
    const double level = std::hypot(r.north_m, r.east_m) / length, down = r.down_m / length;
    return std::hypot(level * r.deviation.value(), down * r.down_deviation.value());
}

NavRelposned relative_position(const ReportContext& context) {
    const std::optional<ToldBaseline> baseline = told_baseline(context.state);
    const NavRelposned0 parts = relative_position_m8(context, baseline);
    NavRelposned m;
    m.ref_station_id = parts.ref_station_id;
    m.i_tow = parts.i_tow;
    m.rel_pos = parts.rel_pos;
    m.rel_pos_hp = parts.rel_pos_hp;
    m.acc = parts.acc;
    m.flags = parts.flags;
    if (!baseline) return m;
    const RelativePosition* relative = &baseline->vector;
    const double length = std::hypot(relative->north_m, relative->east_m, relative->down_m);
    put_split(length, m.rel_pos_length, m.rel_pos_length_hp);
    m.acc_length.set(length_deviation(*relative, length));
    const double heading = std::atan2(relative->east_m, relative->north_m) * 180 / std::numbers::pi;
    m.rel_pos_heading.set(std::fmod(heading + 360, 360.0));
    const double level = std::hypot(relative->north_m, relative->east_m);
    const double heading_deviation = level > 0 ? std::atan2(relative->deviation.value(), level) : std::numbers::pi;
    m.acc_heading.set(std::min(half_turn_deg, heading_deviation * 180 / std::numbers::pi));
    if (relative->base_moves && relative->fixed && level > 0) m.flags |= 0x100;
    return m;
}

NavSvin survey(const ReportContext& context) {
    const std::optional<BaseSurvey>& survey = context.state.survey;
    auto m = stamped<NavSvin>(context);
    if (!survey) return m;
    m.valid = survey->done() ? 1 : 0;
    m.active = survey->done() ? 0 : 1;
    m.dur.set(std::floor(survey->time().value()));
    m.mean_acc = unknown_accuracy;
    const auto mean = survey->mean();
    if (!mean) return m;
    put_split(mean->vector(), m.mean, m.mean_hp);
    m.mean_acc.set(survey->accuracy().value());
    m.obs.set(static_cast<double>(survey->positions()));
    return m;
}

NavDgps differential(const ReportContext& context) {
    constexpr std::int32_t no_age = 999999;  // of a captured receiver without corrections
    const NavigationState& state = context.state;
    auto m = stamped<NavDgps>(context);
    m.age = no_age;
    if (state.corrections.age) m.age.set(state.corrections.age->value());
    m.base_id.set(state.corrections.station.value_or(0));
    if (state.corrections.state == CorrectionState::none) return m;
    m.status = 2;
    for (const SatelliteStatus& s : state.epoch.fix.satellites) {
        const auto number = ubx_single_number(s.id);
        if (!s.used || !number || m.satellites.size() == ubx_most_items) continue;
        NavDgpsItem item;
        item.sv_id = *number;
        item.flags = static_cast<std::uint8_t>(0x10 | (m.satellites.size() & 0x0F));
        if (state.corrections.age) item.age_c.set(state.corrections.age->value());
        m.satellites.push_back(item);
    }
    return m;
}

// Of services that no emulated receiver has in use: the time, and zeros.
template <class Message>
Message service_message(const ReportContext& context) {
    auto m = stamped<Message>(context);
    return m;
}

NavGeofence fences(const ReportContext& context) {
    auto m = stamped<NavGeofence>(context);
    const std::vector<Fence> fences = fences_of(context.config, context.state);
    const bool reliable = context.state.epoch.fix.has_position() && context.state.fix_ok;
    m.status = !fences.empty() && reliable ? 1 : 0;
    m.comb_state = static_cast<std::uint8_t>(combined_state(fences));
    for (const Fence& fence : fences)
        m.fences.push_back({static_cast<std::uint8_t>(fence.state), fence.number});
    return m;
}

NavAopstatus autonomous_orbits(const ReportContext& context) {
    auto m = stamped<NavAopstatus>(context);
    m.aop_cfg = context.config.predicts_orbits ? 1 : 0;
    return m;
}

// Bounds of the position that a normal error passes once in ten million times; u-blox's own formula is not published.
NavPl protection_level(const ReportContext& context) {
    constexpr double sigmas = 5.33;
    const NavigationState& state = context.state;
    const Fix& fix = state.epoch.fix;
    auto m = stamped<NavPl>(context);
    m.tmir_coeff = 1;
    m.tmir_exp = -7;
    m.pl_pos_frame = 1;
    m.pl_pos.fill(unknown_accuracy);
    m.invalidity_reason.fill(1);
    const std::optional<ErrorEllipse> ellipse = error_ellipse(fix);
    if (!state.fix_ok || !fix.has_position() || !ellipse) return m;
    m.pl_pos_valid = 1;
    m.invalidity_reason[0] = 0;
    m.pl_pos.set(0, ellipse->north.value() * sigmas);
    m.pl_pos.set(1, ellipse->east.value() * sigmas);
    m.pl_pos.set(2, fix.vertical_accuracy.value() * sigmas);
    return m;
}

std::vector<Bytes> relative_position_by_generation(const ReportContext& context) {
    return context.board.identity.generation <= 8
               ? ubx_frames_of(relative_position_m8(context, told_baseline(context.state)))
               : ubx_frames_of(relative_position(context));
}

// No emulated receiver has NAV-SLAS in use: the time, and zeros.
constexpr UbxMaker service_makers[] = {maker<solution_covariance>,
                                       maker<ellipse_message>,
                                       maker<odometer>,
                                       maker<stamped<NavEoe>>,
                                       {NavRelposned::message_id, relative_position_by_generation},
                                       maker<survey>,
                                       maker<differential>,
                                       maker<fences>,
                                       maker<stamped<NavSlas>>,
                                       maker<autonomous_orbits>,
                                       maker<protection_level>};

}  // namespace

double reported_dop(double dop, bool computed) {
    return computed && std::isfinite(dop) ? std::min(unknown_dop, dop) : unknown_dop;
}

std::uint8_t used_satellites(const Fix& fix) {
    return fix.type == FixType::none ? std::uint8_t{0} : nearest<std::uint8_t>(fix.satellites_used());
}

std::int32_t course_field(const NavigationState& state) {
    if (!state.course) return 0;
    constexpr std::int32_t turn = 36000000;
    const std::int32_t course = nearest<std::int32_t>(std::fmod(state.course->deg(), 360.0) * 1e5);
    return (course % turn + turn) % turn;
}

double reported_course_accuracy_deg(const NavigationState& state) {
    if (!state.course || state.course_is_frozen) return half_turn_deg;
    return std::min(half_turn_deg, state.epoch.fix.course_accuracy.deg());
}

std::vector<Bytes> make_service_message(UbxMessageId message, const ReportContext& context) {
    return made_by(service_makers, message, context);
}

std::vector<Bytes> make_navigation_message(UbxMessageId message, const ReportContext& context) {
    std::vector<Bytes> frames = make_time_message(message, context);
    if (frames.empty()) frames = make_solution_message(message, context);
    if (frames.empty()) frames = make_service_message(message, context);
    return frames;
}

}  // namespace skyloop::firmware
