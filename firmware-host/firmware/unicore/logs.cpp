#include "firmware/unicore/logs.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "firmware/messages/field_values.hpp"
#include "firmware/unicore/log_parts.hpp"

namespace skyloop::firmware {
namespace {

constexpr std::uint8_t solution_computed = 0x12;  // ext_sol_status of captures, of what there is no other value
constexpr std::uint8_t gal_bds_mask = 0x11, gps_glo_mask = 0x51;
constexpr std::uint32_t sol_computed = 0, doppler_velocity = 8;

void put_best_velocity(const Fix& fix, UnicoreBestNav& log) {
    const UnicoreDeviations deviations = velocity_deviations(fix);
    log.vel_sol_status = sol_computed;
    log.vel_type = doppler_velocity;
    log.speed = fix.speed.value();
    log.course = fix.course.deg();
    log.vel_up = -fix.velocity.down;
    log.vel_up_std = static_cast<float>(deviations.up);
    log.speed_std = static_cast<float>(std::hypot(deviations.north, deviations.east));
}

}  // namespace

UnicoreHeader unicore_header(const ReportContext& context, std::optional<GpsTime> asked) {
    const NavigationState& state = context.state;
    // Until the first epoch after a start there is none to be stamped with.
    const bool any_epoch = state.epoch.fix.time != GpsTime{};
    const GpsTime epoch = any_epoch ? state.epoch.fix.time : asked.value_or(GpsTime{});
    constexpr double longest_s = 65.535, thousandths = 1000;
    UnicoreHeader header;
    header.leap_seconds = state.epoch.fix.leap_seconds;
    header.time_known = state.time.time && state.time.date && (any_epoch || asked);
    Seconds delay = context.board.solution_latency;
    if (asked) delay = difference(*asked, epoch) + context.board.timing.answer;
    header.delay_ms = static_cast<int>(std::lround(std::clamp(delay.value(), 0.0, longest_s) * thousandths));
    const WeekAndTow stamp = gps_stamp(epoch);
    header.week = header.time_known ? static_cast<int>(reported_week(state, stamp)) : 1;
    header.tow_ms =
        header.time_known ? whole_milliseconds(stamp) : nearest<std::uint32_t>(state.since_boot.value() * thousandths);
    return header;
}

UnicoreBestNav unicore_best_nav(const ReportContext& context) {
    const NavigationState& state = context.state;
    const Fix& fix = state.epoch.fix;
    UnicoreBestNav log;
    log.tracked = tracked_satellites(fix);
    if (!has_solution(state)) return log;
    const UnicoreDeviations deviations = position_deviations(fix);
    log.sol_status = sol_computed;
    log.pos_type = unicore_type(state);
    log.lat = fix.position.latitude.deg();
    log.lon = fix.position.longitude.deg();
    log.height = msl_height(fix);
    log.undulation = static_cast<float>(fix.geoid_undulation.value());
    log.lat_std = static_cast<float>(deviations.north);
    log.lon_std = static_cast<float>(deviations.east);
    log.height_std = static_cast<float>(deviations.up);
    put_unicore_station(state, log.station);
    log.diff_age = unicore_age(state);
    log.used = log.used_l1 = reported_satellites(fix);
    log.reserved = 1;
    log.ext_sol_status = solution_computed;
    log.gal_bds_mask = gal_bds_mask;
    log.gps_glo_mask = gps_glo_mask;
    put_best_velocity(fix, log);
    return log;
}

UnicoreRecTime unicore_rec_time(const ReportContext& context) {
    const NavigationState& state = context.state;
    UnicoreRecTime log;
    log.utc_offset = -static_cast<double>(state.epoch.fix.leap_seconds);
    if (!state.time.time || !state.time.date) return log;
    if (estimates_known(state)) {
        log.clock_status = 0u;
        log.offset = -std::chrono::duration<double>(clock_ahead(state)).count();
        log.offset_std = state.time.accuracy.value();
    }
    const UtcTime utc = reported_utc(state);
    constexpr std::uint32_t second_ms = 1000, ms_ns = 1'000'000;
    log.year = static_cast<std::uint32_t>(utc.year);
    log.month = static_cast<std::uint8_t>(utc.month);
    log.day = static_cast<std::uint8_t>(utc.day);
    log.hour = static_cast<std::uint8_t>(utc.hour);
    log.minute = static_cast<std::uint8_t>(utc.minute);
    log.millisecond = utc.second * second_ms + utc.nanosecond / ms_ns;
    log.utc_status = state.time.leap_seconds ? 1u : 0u;
    return log;
}

UnicoreVersion unicore_version(const BoardProfile& board, bool text) {
    UnicoreVersion log;
    log.model = unicore_number(unicore_model_words, "\"" + board.identity.hardware + "\"");
    const auto extension = [&](std::size_t i) {
        return i < board.identity.extensions.size() ? std::string_view(board.identity.extensions[i])
                                                    : std::string_view();
    };
    const std::string_view software = board.identity.software;
    const std::size_t build = software.find("Build");
    put_text(log.firmware, text || build == std::string_view::npos ? software : software.substr(build + 5));
    put_text(log.authorization, extension(0));
    put_text(log.serial, extension(1));
    put_text(log.efuse_id, extension(2));
    put_text(log.compiled, extension(3));
    return log;
}

UnicoreHeading unicore_heading(const ReportContext& context) {
    UnicoreHeading log;
    put_text(log.station, "999");
    log.tracked = tracked_satellites(context.state.epoch.fix);
    const auto other = other_antenna(context);
    if (!other || !has_solution(context.state)) return log;
    log.sol_status = sol_computed;
    log.pos_type = unicore_type_number(other->fixed ? "NARROW_INT" : "NARROW_FLOAT");
    log.length = static_cast<float>(other->length);
    log.heading = static_cast<float>(other->heading_deg);
    log.pitch = static_cast<float>(other->pitch_deg);
    log.heading_std = static_cast<float>(other->heading_std_deg);
    log.pitch_std = static_cast<float>(other->pitch_std_deg);
    log.used = log.observed = log.used_multi = reported_satellites(context.state.epoch.fix);
    log.sol_source = 3;
    log.ext_sol_status = 1;
    log.gal_bds_mask = 3;
    log.gps_glo_mask = 0xF3;
    return log;
}

UnicorePvtsln unicore_pvtsln(const ReportContext& context) {
    const NavigationState& state = context.state;
    const Fix& fix = state.epoch.fix;
    UnicorePvtsln log;
    log.tracked = log.psr_tracked = tracked_satellites(fix);
    log.cutoff = static_cast<float>(context.config.elevation_mask.deg());
    if (!has_solution(state)) return log;
    const UnicoreDeviations deviations = position_deviations(fix);
    log.pos_type = unicore_type(state);
    log.psr_type = unicore_type_number("SINGLE");
    log.height = static_cast<float>(msl_height(fix));
    log.lat = fix.position.latitude.deg();
    log.lon = fix.position.longitude.deg();
    log.psr_height = log.height.raw;
    log.psr_lat = log.lat.raw;
    log.psr_lon = log.lon.raw;
    log.height_std = static_cast<float>(deviations.up);
    log.lat_std = static_cast<float>(deviations.north);
    log.lon_std = static_cast<float>(deviations.east);
    log.diff_age = unicore_age(state);
    log.undulation = static_cast<float>(fix.geoid_undulation.value());
    log.used = log.psr_used = reported_satellites(fix);
    log.vel_north = fix.velocity.north;
    log.vel_east = fix.velocity.east;
    log.vel_up = -fix.velocity.down;
    if (const auto other = other_antenna(context)) {
        log.heading_type = unicore_type_number(other->fixed ? "NARROW_INT" : "NARROW_FLOAT");
        log.length = static_cast<float>(other->length);
        log.heading = static_cast<float>(other->heading_deg);
        log.pitch = static_cast<float>(other->pitch_deg);
        log.heading_tracked = log.tracked;
        log.heading_used = log.heading_observed = log.heading_multi = log.used;
    }
    log.gdop = static_cast<float>(fix.dop.gdop);
    log.pdop = static_cast<float>(fix.dop.pdop);
    log.hdop = static_cast<float>(fix.dop.hdop);
    log.htdop = static_cast<float>(std::hypot(fix.dop.hdop, fix.dop.tdop));
    log.tdop = static_cast<float>(fix.dop.tdop);
    for (const SatelliteStatus& s : fix.satellites)
        if (s.used) log.prns.push_back({unicore_prn(s.id)});
    return log;
}

}  // namespace skyloop::firmware
