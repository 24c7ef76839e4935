#include "firmware/sentences/nmea_report.hpp"

#include <algorithm>
#include <array>

#include "firmware/messages/field_values.hpp"

namespace skyloop::firmware {
namespace {

// The flags of one kind of solution (RECEIVER.md 5.4).
struct SolutionFlags {
    int quality;
    int fix_mode;
    NmeaMode mode;
    NmeaMode course_mode;
};

SolutionFlags solution_flags(FixType type) {
    using enum NmeaMode;
    switch (type) {
        case FixType::none:
        case FixType::time_only:
            return {0, 1, none, none};
        case FixType::dead_reckoning:
            return {6, 2, estimated, estimated};
        case FixType::fix_2d:
            return {1, 2, autonomous, autonomous};
        case FixType::fix_3d:
            return {1, 3, autonomous, autonomous};
        case FixType::dgnss:
            return {2, 3, differential, differential};
        case FixType::rtk_float:
            return {5, 3, rtk_float, differential};
        case FixType::rtk_fixed:
            return {4, 3, rtk_fixed, differential};
    }
    return {0, 1, none, none};
}

// What the board calls it instead. Mode P came with version 4.0 (gpsd, www/NMEA.adoc, FAA Mode Indicator).
SolutionFlags as_told(SolutionFlags flags, ToldQuality told, NmeaVersion version) {
    constexpr int pps = 3, entered = 7, simulated = 8, autonomous = 1;
    const NmeaMode precise = version >= NmeaVersion::v4_0 ? NmeaMode::precise : NmeaMode::autonomous;
    switch (told) {
        case ToldQuality::solved:
            return flags;
        case ToldQuality::precise:
            if (flags.quality != autonomous) return flags;
            return {pps, flags.fix_mode, precise, precise};
        case ToldQuality::manual:
            return {entered, flags.fix_mode, NmeaMode::manual, NmeaMode::manual};
        case ToldQuality::simulator:
            return {simulated, flags.fix_mode, NmeaMode::simulator, NmeaMode::simulator};
    }
    return flags;
}

// Beyond the user's limits only dead reckoning still shows (RECEIVER.md 5.4, second row).
SolutionFlags flags_beyond_limits(FixType type) {
    if (type == FixType::dead_reckoning) return {6, 2, NmeaMode::none, NmeaMode::none};
    return {0, 1, NmeaMode::none, NmeaMode::none};
}

std::string own_talker(const NmeaSystem& system, const BoardProfile& board, const ReceiverConfig& config) {
    if (system.talker == "GB") return config.nmea.beidou_talker;
    if (system.talker == "GQ") return board.style.qzss_talker;
    return std::string(system.talker);
}

void add_groups(NmeaReport& r, const std::vector<Constellation>& listed) {
    const ReportContext& c = r.context;
    for (const Constellation constellation : listed) {
        const NmeaSystem system = nmea_system(constellation, r.format.version);
        const auto same = [&](const NmeaGroup& group) { return group.system == system; };
        if (std::ranges::any_of(r.groups, same)) continue;
        r.groups.push_back({system,
                            c.config.nmea.main_talker_everywhere ? r.talker : own_talker(system, c.board, c.config),
                            tracked_signal_id(r, constellation, first_signal(constellation))});
    }
    std::ranges::sort(r.groups,
                      [](const NmeaGroup& a, const NmeaGroup& b) { return a.system.system_id < b.system.system_id; });
}

// The solution weighed it and left it out. One below the mask has a residual too, but was never a candidate.
bool is_considered(const NmeaReport& r, const SatelliteStatus& s) {
    if (!s.residual || !s.healthy) return false;
    return s.elevation.deg() >= r.context.config.elevation_mask.deg();
}

// Satellites that the solution looked at and left out may be counted, too.
void add_satellites(NmeaReport& r, const std::vector<Constellation>& enabled,
                    const std::vector<Constellation>& listed) {
    const auto within = [](const std::vector<Constellation>& list, const SatelliteStatus& s) {
        return std::ranges::find(list, s.id.constellation) != list.end();
    };
    const bool consider = r.context.config.nmea.counts_considered;
    for (const SatelliteStatus& s : r.fix().satellites) {
        if (!within(enabled, s)) continue;
        const bool counted = s.used || (consider && is_considered(r, s));
        if (r.solved && counted) ++r.satellites_counted;
        if (!within(listed, s)) continue;
        r.satellites.push_back(s);
        if (r.solved && s.used) r.used.push_back(s);
    }
}

void add_time_and_date(NmeaReport& r) {
    const NmeaConfig& config = r.context.config.nmea;
    const TimeKnowledge& known = r.context.state.time;
    UtcTime utc = reported_utc(r.context);
    bool time = known.time || config.shows_invalid_time;
    bool date = known.date || config.shows_invalid_date;
    const bool before_both = !known.time || (!known.date && !r.solved);
    if (r.context.board.style.unknown_date_is_1980 && before_both) {
        // Such receivers count from 23:59:46 of 5 January 1980 on (RECEIVER.md 5.8) until they know both, as with a
        // fix.
        constexpr auto before_gps_time = std::chrono::seconds(14);
        const Nanoseconds on = to_nanoseconds(r.context.state.since_start);
        utc = to_utc(GpsTime(on - before_gps_time), LeapSeconds::constant(0));
        time = date = true;
    }
    if (time) r.time = nmea_time(utc);
    if (date) r.date = nmea_date(utc);
}

void add_position_and_motion(NmeaReport& r) {
    const auto& [board, config, state, ports, port, following] = r.context;
    const bool any = (config.nmea.shows_invalid_fix || state.old_position_shown) && state.position_known;
    const bool beyond_limits = r.solved && config.nmea.shows_masked_fix;
    if (!r.valid && !any && !beyond_limits) {
        if (!board.style.zeros_without_fix) return;
        r.speed = MetresPerSecond(0);
        r.course = Angle();
        return;
    }
    const Fix& fix = r.fix();
    r.position = NmeaPosition{fix.position.latitude, fix.position.longitude};
    r.speed = fix.speed;
    const bool frozen = state.course_is_frozen || fix.speed < board.course_min_speed;
    if (board.style.course_always)
        r.course = state.course.value_or(fix.course);
    else if (!frozen || config.nmea.shows_frozen_course)
        r.course = state.course;
}

}  // namespace

std::string nmea_talker(const BoardProfile& board, const ReceiverConfig& config) {
    using enum Constellation;
    if (!config.nmea.talker.empty()) return config.nmea.talker;
    if (config.nmea.version == NmeaVersion::v2_1 || config.nmea.gps_only) return "GP";
    std::string talker;
    for (const Constellation system : {gps, galileo, beidou, glonass}) {
        if (!config.has_on(system)) continue;
        if (!talker.empty()) return "GN";
        talker = own_talker(nmea_system(system, config.nmea.version), board, config);
    }
    return talker.empty() ? "GP" : talker;
}

int tracked_signal_id(const NmeaReport& report, Constellation constellation, Signal signal) {
    const bool b1c = signal == Signal::b1i && report.context.config.settings.beidou_b1c;
    return nmea_signal_id(constellation, b1c ? Signal::l1 : signal, report.format.version);
}

std::optional<Dop> shown_dops(const NmeaReport& report) {
    const double not_computed = report.context.board.style.unknown_dop;
    if (has_dops(report.fix())) return report.fix().dop;
    if (report.context.board.style.zeros_without_fix) return std::nullopt;
    return Dop{.pdop = not_computed, .hdop = not_computed, .vdop = not_computed};
}

NmeaFormat nmea_format(const BoardProfile& board, const ReceiverConfig& config) {
    constexpr int compatible_time_decimals = 3, precise_coordinate_decimals = 7, precise_altitude_decimals = 3;
    NmeaFormat format{.version = config.nmea.version,
                      .time_decimals = board.time_decimals,
                      .coordinate_decimals = board.coordinate_decimals,
                      .altitude_decimals = board.style.altitude_decimals,
                      .limit_82 = config.nmea.limit_82,
                      .speed_decimals = board.style.speed_decimals,
                      .course_decimals = board.style.course_decimals,
                      .vtg_speed_decimals = board.style.vtg_speed_decimals,
                      .vtg_course_decimals = board.style.vtg_course_decimals,
                      .magnetic_fields = board.style.magnetic_fields,
                      .magnetic_variation_deg = board.style.magnetic_variation_deg,
                      .heading_decimals = board.style.heading_decimals,
                      .rmc_status = board.style.rmc_status.empty() ? 'V' : board.style.rmc_status.front(),
                      .empty_gsv_fields = board.style.tracked_only,
                      .dop_decimals = board.style.dop_decimals,
                      .most_dop = board.style.unknown_dop,
                      .satellites_padded = board.style.satellites_padded,
                      .units_always = board.style.zeros_without_fix,
                      .deviations_padded = board.style.gst_padded,
                      .no_station = board.style.station_field};
    if (config.nmea.compatible) format.time_decimals = compatible_time_decimals;
    if (config.nmea.high_precision) {
        format.coordinate_decimals = precise_coordinate_decimals;
        format.altitude_decimals = precise_altitude_decimals;
    }
    return format;
}

UtcTime reported_utc(const ReportContext& context) {
    const ReportedTime now = reported_time(context);
    return rounded_utc(now.time, context.board.time_decimals, counted_leap_seconds(now));
}

const NavigationState* told_state(UbxMessageId message, const ReportContext& context) {
    const auto late = context.board.style.late.find(message);
    if (late == context.board.style.late.end()) return &context.state;
    const auto epochs = static_cast<std::size_t>(late->second);
    return epochs <= context.state.earlier.size() ? context.state.earlier[epochs - 1].get() : nullptr;
}

NmeaReport nmea_report(const ReportContext& context) {
    const auto& [board, config, state, ports, port, following] = context;
    NmeaReport r{.context = context,
                 .format = nmea_format(board, config),
                 .numbering = config.nmea.numbering,
                 .talker = nmea_talker(board, config)};
    const FixType type = r.fix().type;
    r.solved = r.fix().has_position();
    r.valid = r.solved && state.fix_ok;
    const ToldQuality told = board.style.quality;
    const SolutionFlags flags =
        r.valid ? as_told(solution_flags(type), told, r.format.version) : flags_beyond_limits(type);
    // Status A is for the modes of a receiver that measures (NMEA 0183, RMC).
    const bool measured = flags.mode != NmeaMode::manual && flags.mode != NmeaMode::simulator;
    r.status = r.valid && (measured || board.style.simulated_is_valid);
    r.quality = flags.quality;
    r.fix_mode = flags.fix_mode;
    r.mode = flags.mode;
    r.course_mode = flags.course_mode;
    std::vector<Constellation> enabled = config.systems, listed;
    if (config.nmea.gps_only) std::erase_if(enabled, [](Constellation c) { return c != Constellation::gps; });
    for (const Constellation c : enabled)
        if (!config.nmea.left_out.contains(c)) listed.push_back(c);
    add_groups(r, listed);
    add_satellites(r, enabled, listed);
    add_time_and_date(r);
    add_position_and_motion(r);
    return r;
}

}  // namespace skyloop::firmware
