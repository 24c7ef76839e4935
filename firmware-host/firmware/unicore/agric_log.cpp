// AGRICA and AGRICB.
#include <algorithm>
#include <cmath>

#include "base/geo/local_frame.hpp"
#include "firmware/messages/field_values.hpp"
#include "firmware/unicore/log_parts.hpp"
#include "firmware/unicore/logs.hpp"

namespace skyloop::firmware {
namespace {

// As the quality of GGA: 1 single, 2 differential, 4 fixed, 5 float.
std::uint8_t unicore_status(const NavigationState& state) {
    if (!has_solution(state)) return 0;
    switch (state.epoch.fix.type) {
        case FixType::dgnss:
            return 2;
        case FixType::rtk_float:
            return 5;
        case FixType::rtk_fixed:
            return 4;
        default:
            return 1;
    }
}

std::uint8_t used_satellites_of(const Fix& fix, Constellation system) {
    return nearest<std::uint8_t>(static_cast<double>(std::ranges::count_if(
        fix.satellites, [&](const SatelliteStatus& s) { return s.used && s.id.constellation == system; })));
}

void put_agric_time(const NavigationState& state, UnicoreAgric& log) {
    if (!state.time.time || !state.time.date) return;
    const UtcTime utc = reported_utc(state);
    log.year = nearest<std::uint8_t>(utc.year - 2000.0);
    log.month = static_cast<std::uint8_t>(utc.month);
    log.day = static_cast<std::uint8_t>(utc.day);
    log.hour = static_cast<std::uint8_t>(utc.hour);
    log.minute = static_cast<std::uint8_t>(utc.minute);
    log.second = static_cast<std::uint8_t>(utc.second);
    log.tow = whole_milliseconds(gps_stamp(state));
}

void put_agric_place(const Fix& fix, UnicoreAgric& log) {
    const UnicoreDeviations deviations = position_deviations(fix);
    log.lat = fix.position.latitude.deg();
    log.lon = fix.position.longitude.deg();
    log.height = msl_height(fix);
    const auto ecef = to_ecef(fix.position).vector();
    log.x = ecef.x();
    log.y = ecef.y();
    log.z = ecef.z();
    log.lat_std = static_cast<float>(deviations.north);
    log.lon_std = static_cast<float>(deviations.east);
    log.height_std = static_cast<float>(deviations.up);
    const LocalFrame frame(fix.position);
    const auto variances = [&](double east, double north, double up) {
        return frame.to_ecef(Velocity<Enu>(Eigen::Vector3d(east, north, up))).vector().cwiseAbs2().eval();
    };
    const Eigen::Vector3d deviation =
        (variances(deviations.east, 0, 0) + variances(0, deviations.north, 0) + variances(0, 0, deviations.up))
            .cwiseSqrt();
    log.x_std = static_cast<float>(deviation.x());
    log.y_std = static_cast<float>(deviation.y());
    log.z_std = static_cast<float>(deviation.z());
    log.undulation = static_cast<float>(fix.geoid_undulation.value());
}

void put_agric_velocity(const Fix& fix, UnicoreAgric& log) {
    const UnicoreDeviations deviations = velocity_deviations(fix);
    log.speed = static_cast<float>(fix.speed.value());
    log.vel_north = static_cast<float>(fix.velocity.north);
    log.vel_east = static_cast<float>(fix.velocity.east);
    log.vel_up = static_cast<float>(-fix.velocity.down);
    log.vel_north_std = static_cast<float>(deviations.north);
    log.vel_east_std = static_cast<float>(deviations.east);
    log.vel_up_std = static_cast<float>(deviations.up);
    log.course = static_cast<float>(fix.course.deg());
}

// Of a base that stands and whose corrections are in the solution.
void put_agric_base(const NavigationState& state, UnicoreAgric& log) {
    const CorrectionStatus& corrections = state.corrections;
    if (corrections.state == CorrectionState::none || !corrections.base) return;
    const Geodetic base = to_geodetic(*corrections.base);
    const Eigen::Vector3d to_rover = LocalFrame(base).to_enu(to_ecef(state.epoch.fix.position)).vector();
    log.baseline_north = static_cast<float>(to_rover.y());
    log.baseline_east = static_cast<float>(to_rover.x());
    log.baseline_up = static_cast<float>(to_rover.z());
    const UnicoreDeviations deviations = position_deviations(state.epoch.fix);
    log.baseline_north_std = static_cast<float>(deviations.north);
    log.baseline_east_std = static_cast<float>(deviations.east);
    log.baseline_up_std = static_cast<float>(deviations.up);
    log.base_lat = base.latitude.deg();
    log.base_lon = base.longitude.deg();
    log.base_height = base.height.above_ellipsoid.value();
    log.diff_age = unicore_age(state);
}

void put_agric_second(const ReportContext& context, UnicoreAgric& log) {
    const auto other = other_antenna(context);
    if (!other) return;
    log.heading_status = other->fixed ? std::uint8_t{4} : std::uint8_t{5};
    log.heading = static_cast<float>(other->heading_deg);
    log.pitch = static_cast<float>(other->pitch_deg);
    const RelativePosition& r = *context.state.epoch.relative;
    const Geodetic second = to_geodetic(
        LocalFrame(context.state.epoch.fix.position).to_ecef(Position<Enu>{r.east_m, r.north_m, -r.down_m}));
    log.second_lat = second.latitude.deg();
    log.second_lon = second.longitude.deg();
    log.second_height = second.height.above_ellipsoid.value() - context.state.epoch.fix.geoid_undulation.value();
}

}  // namespace

UnicoreAgric unicore_agric(const ReportContext& context) {
    const NavigationState& state = context.state;
    const Fix& fix = state.epoch.fix;
    UnicoreAgric log;
    put_agric_time(state, log);
    if (!has_solution(state)) return log;
    log.rtk_status = unicore_status(state);
    log.gps = used_satellites_of(fix, Constellation::gps);
    log.bds = used_satellites_of(fix, Constellation::beidou);
    log.glo = used_satellites_of(fix, Constellation::glonass);
    log.gal = used_satellites_of(fix, Constellation::galileo);
    put_agric_place(fix, log);
    put_agric_velocity(fix, log);
    put_agric_base(state, log);
    put_agric_second(context, log);
    return log;
}

}  // namespace skyloop::firmware
