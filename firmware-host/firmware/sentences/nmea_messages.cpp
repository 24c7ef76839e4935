// Sentences of the receiver's state, and PUBX,00, 03 and 04 (u-blox M8 interface description UBX-13003221, PUBX
// messages).

#include <algorithm>
#include <cmath>

#include "firmware/core/port_id.hpp"
#include "firmware/core/solution_covariance.hpp"
#include "firmware/core/told_heading.hpp"
#include "firmware/messages/field_values.hpp"
#include "firmware/messages/make_message.hpp"
#include "firmware/sentences/nmea_report.hpp"
#include "receiver/protocol/nmea_pubx.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::firmware {
namespace {

// What GGA and GNS share: height, age and station of corrections.
template <class Message>
void add_height_and_corrections(Message& m, const NmeaReport& r) {
    if (r.position) {
        const ToldGeoid told = r.context.board.style.geoid;
        const bool is_known = told == ToldGeoid::separation;
        const Metres geoid = is_known ? r.fix().geoid_undulation : Metres(0);
        m.altitude = above_sea_level(r.fix().position.height, geoid).above_sea_level;
        if (told != ToldGeoid::nothing) m.geoid_separation = geoid;
    }
    if (r.course_mode != NmeaMode::differential) return;
    const CorrectionStatus& corrections = r.context.state.corrections;
    if (corrections.state != CorrectionState::none) m.correction_age = corrections.age;
    // Corrections from SBAS come with no station of their own and an age that is not shown (capture in
    // RECEIVER.md 5.3).
    m.correction_station = m.correction_age ? corrections.station.value_or(0) : 0;
}

Gga gga(const NmeaReport& r) {
    Gga m;
    m.talker = r.talker;
    m.time = r.time;
    m.position = r.position;
    m.quality = r.quality;
    m.satellites_used = std::min(r.satellites_counted, r.context.board.max_listed_satellites);
    if (const auto dops = shown_dops(r)) m.hdop = dops->hdop;
    add_height_and_corrections(m, r);
    return m;
}

// One character for each of GPS, GLONASS, Galileo and BeiDou; version 4.0 leaves out the last two while they are off.
std::vector<NmeaMode> modes_of_systems(const NmeaReport& r) {
    constexpr Constellation in_order[] = {Constellation::gps, Constellation::glonass, Constellation::galileo,
                                          Constellation::beidou};
    std::vector<NmeaMode> modes;
    std::size_t shown = r.format.version >= NmeaVersion::v4_10 ? std::size(in_order) : 2;
    for (std::size_t i = 0; i < std::size(in_order); ++i) {
        const bool used = std::any_of(r.used.begin(), r.used.end(),
                                      [&](const SatelliteStatus& s) { return s.id.constellation == in_order[i]; });
        const bool on = r.context.config.has_on(in_order[i]);
        // Dead reckoning uses none of them, and is told of all that are on (RECEIVER.md 5.4).
        const bool reckoned = on && r.mode == NmeaMode::estimated;
        modes.push_back(used || reckoned ? r.mode : NmeaMode::none);
        if (on) shown = std::max(shown, i + 1);
    }
    modes.resize(shown);
    return modes;
}

Gns gns(const NmeaReport& r) {
    Gns m;
    m.talker = r.talker;
    m.time = r.time;
    m.position = r.position;
    m.modes = modes_of_systems(r);
    m.satellites_used = r.satellites_counted;
    if (const auto dops = shown_dops(r)) m.hdop = dops->hdop;
    add_height_and_corrections(m, r);
    return m;
}

Gst gst(const NmeaReport& r) {
    Gst m;
    m.talker = r.talker;
    m.time = r.time;
    if (!r.position || !r.solved) return m;
    if (const auto ellipse = error_ellipse(r.fix(), r.used)) {
        m.range_rms = r.fix().horizontal_accuracy / std::hypot(r.fix().dop.edop, r.fix().dop.ndop);
        if (r.context.board.style.gst_ellipse) {
            m.semi_major = ellipse->semi_major;
            m.semi_minor = ellipse->semi_minor;
            m.orientation = ellipse->orientation;
        }
        m.latitude = ellipse->north;
        m.longitude = ellipse->east;
    }
    m.altitude = r.fix().vertical_accuracy;
    return m;
}

Gbs gbs(const NmeaReport& r) {
    Gbs m;
    m.talker = r.talker;
    m.time = r.time;
    if (!r.position || !r.solved) return m;
    if (const auto ellipse = error_ellipse(r.fix(), r.used)) {
        m.latitude = ellipse->north;
        m.longitude = ellipse->east;
    }
    m.altitude = r.fix().vertical_accuracy;
    return m;
}

Vlw vlw(const NmeaReport& r) {
    return {r.talker, Metres(r.context.state.odometer_total_m), Metres(r.context.state.odometer_m)};
}

Dtm dtm(const NmeaReport& r) {
    Dtm m;
    m.talker = r.talker;
    return m;
}

std::string heading_talker(const NmeaReport& r) {
    const std::string& own = r.context.board.style.heading_talker;
    return own.empty() ? r.talker : own;
}

std::optional<ToldHeading> heading_of(const NmeaReport& r) {
    return told_heading(r.context.state, r.context.board.style.heading);
}

Ths ths(const NmeaReport& r) {
    const auto told = heading_of(r);
    if (!told) return {heading_talker(r), std::nullopt, 'V'};
    const bool estimated = told->from == HeadingSource::course;
    const bool invented = r.mode == NmeaMode::manual || r.mode == NmeaMode::simulator;
    return {heading_talker(r), told->heading, invented ? static_cast<char>(r.mode) : estimated ? 'E' : 'A'};
}

Hdt hdt(const NmeaReport& r) {
    const auto told = heading_of(r);
    return {heading_talker(r), told ? std::optional(told->heading) : std::nullopt};
}

Hdg hdg(const NmeaReport& r) {
    const auto told = heading_of(r);
    const Angle variation = Angle::degrees(r.format.magnetic_variation_deg);
    return {heading_talker(r), told ? std::optional(told->heading - variation) : std::nullopt, variation};
}

Rot rot(const NmeaReport& r) {
    const auto rate = heading_of(r) ? r.context.state.turn_rate_dpm : std::nullopt;
    return {heading_talker(r), rate, rate.has_value()};
}

Rmc rmc(const NmeaReport& r) { return {r.talker, r.time, r.status, r.position, r.speed, r.course, r.date, r.mode}; }

// Receivers whose lists have what is tracked alone say GP while there is nothing (capture of a UM980,
// jclark/satpulse, gps/testdata/packets/unicore/UM980/nmea-default.jsonl).
std::string talker_of_lists(const NmeaReport& r) {
    return r.context.board.style.tracked_only && !r.valid ? "GP" : r.talker;
}

std::vector<NmeaMessage> messages_of(NmeaSentence sentence, const NmeaReport& r) {
    const auto all = [](const auto& list) { return std::vector<NmeaMessage>(list.begin(), list.end()); };
    switch (sentence) {
        case NmeaSentence::rmc:
            return {rmc(r)};
        case NmeaSentence::vtg:
            return {Vtg{talker_of_lists(r), r.course, r.speed, r.course_mode}};
        case NmeaSentence::gga:
            return {gga(r)};
        case NmeaSentence::gns:
            return {gns(r)};
        case NmeaSentence::gsa:
            return all(gsa_messages(r));
        case NmeaSentence::gsv:
            return all(gsv_messages(r));
        case NmeaSentence::gll:
            return {Gll{r.talker, r.position, r.time, r.status, r.course_mode}};
        case NmeaSentence::gst:
            return {gst(r)};
        case NmeaSentence::zda:
            return {Zda{r.talker, r.time, r.date}};
        case NmeaSentence::gbs:
            return {gbs(r)};
        case NmeaSentence::dtm:
            return {dtm(r)};
        case NmeaSentence::grs:
            return all(grs_messages(r));
        case NmeaSentence::vlw:
            return {vlw(r)};
        case NmeaSentence::ths:
            return {ths(r)};
        case NmeaSentence::hdt:
            return {hdt(r)};
        case NmeaSentence::hdg:
            return {hdg(r)};
        case NmeaSentence::rot:
            return {rot(r)};
    }
    return {};
}

}  // namespace

std::vector<Bytes> make_nmea_message(UbxMessageId message, const NmeaReport& report) {
    if (message.message_class == class_pubx) return pubx_sentences(message.id, report);
    if (message.message_class != class_nmea) return {};
    const auto* const known = std::ranges::find(nmea_sentence_ids, message.id);
    if (known == std::end(nmea_sentence_ids)) return {};
    std::vector<Bytes> out;
    for (const NmeaMessage& m : messages_of(static_cast<NmeaSentence>(known - std::begin(nmea_sentence_ids)), report))
        out.push_back(to_bytes(encode(m, report.format)));
    return out;
}

namespace {

// What a receiver says of a position that it never had (capture in RECEIVER.md 5.7).
constexpr Metres no_horizontal_accuracy{5303356}, no_vertical_accuracy{3750039};

std::string status_of_rmc(const NmeaReport& r) {
    if (r.fix().type == FixType::time_only) return "TT";
    if (!r.valid) return "NF";
    switch (r.fix().type) {
        case FixType::dead_reckoning:
            return "DR";
        case FixType::fix_2d:
            return "G2";
        case FixType::fix_3d:
            return "G3";
        default:
            return "D3";
    }
}

PubxPosition pubx_position(const NmeaReport& r) {
    const NavigationState& state = r.context.state;
    const Fix& fix = r.fix();
    PubxPosition m;
    m.time = r.time;
    m.status = status_of_rmc(r);
    m.horizontal_accuracy = no_horizontal_accuracy;
    m.vertical_accuracy = no_vertical_accuracy;
    if (!state.position_known && !r.solved) return m;
    m.position = {fix.position.latitude, fix.position.longitude};
    m.altitude = fix.position.height.above_ellipsoid;
    if (!state.only_place_known) {
        m.horizontal_accuracy = fix.horizontal_accuracy;
        m.vertical_accuracy = fix.vertical_accuracy;
    }
    m.speed = fix.speed;
    m.course = state.course.value_or(fix.course);
    m.down = MetresPerSecond(fix.velocity.down);
    if (!r.solved) return m;
    if (state.corrections.state != CorrectionState::none && state.corrections.age)
        m.correction_age_s = static_cast<int>(std::lround(state.corrections.age->value()));
    if (has_dops(fix)) {
        m.hdop = fix.dop.hdop;
        m.vdop = fix.dop.vdop;
        m.tdop = fix.dop.tdop;
    }
    m.satellites_used = r.satellites_counted;
    m.dead_reckoning = fix.type == FixType::dead_reckoning;
    return m;
}

// Of the longest held signal; who measures nothing has held it for long.
int lock_seconds(const NmeaReport& r, const SatelliteStatus& s) {
    constexpr int longest = 64;
    const auto& observed = r.context.state.epoch.observations.signals;
    if (!s.cn0) return 0;
    if (observed.empty()) return longest;
    double lock = 0;
    for (const Observation& o : observed)
        if (o.satellite == s.id) lock = std::max(lock, o.lock_time.value());
    return static_cast<int>(std::min<double>(lock, longest));
}

PubxSatellites pubx_satellites(const NmeaReport& r) {
    PubxSatellites m;
    for (const SatelliteStatus& s : r.satellites) {
        const auto number = single_byte_number(s.id);
        if (!number) continue;
        PubxSatellite line;
        line.number = *number;
        line.status = s.used && r.solved ? 'U' : s.has_ephemeris ? 'e' : '-';
        if (direction_known(s, r.context.state)) {
            line.azimuth_deg = (static_cast<int>(std::lround(s.azimuth.deg())) % 360 + 360) % 360;
            line.elevation_deg = std::clamp(static_cast<int>(std::lround(s.elevation.deg())), 0, 90);
        }
        if (s.cn0) line.cn0_dbhz = static_cast<int>(std::lround(std::clamp(s.cn0->value(), 0.0, 99.0)));
        line.lock_s = lock_seconds(r, s);
        m.satellites.push_back(line);
    }
    return m;
}

PubxTime pubx_time(const NmeaReport& r) {
    constexpr double nanoseconds = 1e9;
    constexpr int granularity_ns = 16;  // capture of an M8 in RECEIVER.md 5.7
    const Fix& fix = r.fix();
    PubxTime m;
    m.time = r.time;
    m.date = r.date;
    if (r.context.state.time.time && r.context.state.time.date) {
        const WeekAndTow utc = week_and_tow(to_gps_time(reported_utc(r.context), LeapSeconds::constant(0)));
        m.utc_week = static_cast<int>(reported_week(r.context.state, utc));
        m.utc_tow_s = utc.tow_seconds();
    }
    m.leap_seconds = fix.leap_seconds;
    m.leap_seconds_by_default = !r.context.state.time.leap_seconds;
    m.clock_bias_ns = fix.clock_bias.value() / speed_of_light * nanoseconds;
    m.clock_drift_ns_s = fix.clock_drift.value() / speed_of_light * nanoseconds;
    m.granularity_ns = granularity_ns;
    return m;
}

}  // namespace

std::vector<Bytes> pubx_sentences(int number, const NmeaReport& r) {
    switch (number) {
        case 0:
            return {to_bytes(encode(pubx_position(r), r.format))};
        case 3:
            return {to_bytes(encode(pubx_satellites(r), r.format))};
        case 4:
            return {to_bytes(encode(pubx_time(r), r.format))};
        default:
            return {};
    }
}

}  // namespace skyloop::firmware
