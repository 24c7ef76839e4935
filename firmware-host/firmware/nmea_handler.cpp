#include "firmware/nmea_handler.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "firmware/error_ellipse.hpp"

namespace skyloop::firmware {
namespace {

constexpr double no_dop = 99.99;

// The flags of one kind of solution (RECEIVER.md 5.4).
struct FixFlags {
    int quality;
    int fix_mode;
    NmeaMode mode;         ///< of RMC
    NmeaMode course_mode;  ///< of GLL and VTG, which know no RTK
};

FixFlags fix_flags(FixType type) {
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

// "GN" for more than one of the major systems, otherwise the system's own (RECEIVER.md 5.2).
std::string main_talker(const std::vector<Constellation>& enabled) {
    std::string talker;
    for (const Constellation c : enabled) {
        if (c == Constellation::sbas || c == Constellation::qzss) continue;
        if (!talker.empty()) return "GN";
        talker = nmea_system(c, NmeaVersion::v4_11).talker;
    }
    return talker.empty() ? "GP" : talker;
}

std::vector<NmeaSystem> listed_systems(const std::vector<Constellation>& enabled, NmeaVersion version) {
    std::vector<NmeaSystem> systems;
    for (const Constellation c : enabled) {
        const NmeaSystem system = nmea_system(c, version);
        if (std::find(systems.begin(), systems.end(), system) == systems.end()) systems.push_back(system);
    }
    std::sort(systems.begin(), systems.end(), [](auto& a, auto& b) { return a.system_id < b.system_id; });
    return systems;
}

std::vector<SentenceRate> in_output_order(std::vector<SentenceRate> sentences) {
    std::stable_sort(sentences.begin(), sentences.end(), [](auto& a, auto& b) { return a.sentence < b.sentence; });
    return sentences;
}

// During an announced leap second the receiver counts to 60; with any other belief about the offset it just subtracts.
LeapSeconds believed_leap_seconds(const Fix& fix) {
    const LeapSeconds& announced = LeapSeconds::announced();
    return announced.offset(fix.time) == fix.leap_seconds ? announced : LeapSeconds::constant(fix.leap_seconds);
}

int whole_degrees(Angle angle) { return static_cast<int>(std::lround(angle.deg())); }

}  // namespace

// What all sentences of one epoch share.
struct NmeaHandler::Report {
    const Fix& fix;
    int quality;
    int fix_mode;
    NmeaMode mode;
    NmeaMode course_mode;
    std::optional<NmeaTime> time;
    std::optional<NmeaDate> date;
    std::optional<NmeaPosition> position;
    std::optional<MetresPerSecond> speed;
    std::optional<Angle> course;
    std::vector<SatelliteStatus> satellites;  ///< of enabled constellations
    std::vector<SatelliteStatus> used;
};

NmeaHandler::NmeaHandler(const BoardProfile& board)
    : format_{.version = board.nmea_version,
              .time_decimals = board.time_decimals,
              .coordinate_decimals = board.coordinate_decimals},
      numbering_(board.satellite_numbering),
      talker_(board.main_talker.empty() ? main_talker(board.constellations) : board.main_talker),
      constellations_(board.constellations),
      systems_(listed_systems(board.constellations, board.nmea_version)),
      max_listed_satellites_(board.max_listed_satellites),
      course_min_speed_(board.course_min_speed),
      plan_(in_output_order(board.sentences)) {}

std::vector<std::string> NmeaHandler::sentences(const Epoch& epoch, std::uint64_t index) {
    if (epoch.fix.type != FixType::none) time_known_ = true;
    const Report shared = report(epoch.fix);
    std::vector<std::string> out;
    for (const SentenceRate& rate : plan_)
        if (rate.every_epochs > 0 && index % static_cast<std::uint64_t>(rate.every_epochs) == 0)
            append(out, rate.sentence, shared);
    return out;
}

std::string NmeaHandler::text_message(int type, const std::string& text) const {
    return encode(Txt{.talker = talker_, .count = 1, .index = 1, .type = type, .text = text}, format_);
}

NmeaHandler::Report NmeaHandler::report(const Fix& fix) const {
    const FixFlags flags = fix_flags(fix.type);
    Report r{fix, flags.quality, flags.fix_mode, flags.mode, flags.course_mode, {}, {}, {}, {}, {}, {}, {}};
    if (time_known_) {
        const UtcTime utc = rounded_utc(fix.time, format_.time_decimals, believed_leap_seconds(fix));
        r.time = nmea_time(utc);
        r.date = nmea_date(utc);
    }
    for (const SatelliteStatus& s : fix.satellites) {
        const auto& enabled = constellations_;
        if (std::find(enabled.begin(), enabled.end(), s.id.constellation) == enabled.end()) continue;
        r.satellites.push_back(s);
        if (s.used && fix.has_position()) r.used.push_back(s);
    }
    if (!fix.has_position()) return r;
    r.position = NmeaPosition{fix.position.latitude, fix.position.longitude};
    r.speed = fix.speed;
    if (fix.speed >= course_min_speed_) r.course = fix.course;
    return r;
}

void NmeaHandler::append(std::vector<std::string>& out, NmeaSentence sentence, const Report& r) const {
    const bool valid = r.fix.has_position();
    switch (sentence) {
        case NmeaSentence::rmc:
            out.push_back(encode(Rmc{talker_, r.time, valid, r.position, r.speed, r.course, r.date, r.mode}, format_));
            return;
        case NmeaSentence::vtg:
            out.push_back(encode(Vtg{talker_, r.course, r.speed, r.course_mode}, format_));
            return;
        case NmeaSentence::gga:
            out.push_back(encode(gga(r), format_));
            return;
        case NmeaSentence::gsa:
            append_gsa(out, r);
            return;
        case NmeaSentence::gsv:
            append_gsv(out, r);
            return;
        case NmeaSentence::gll:
            out.push_back(encode(Gll{talker_, r.position, r.time, valid, r.course_mode}, format_));
            return;
        case NmeaSentence::gst:
            out.push_back(encode(gst(r), format_));
            return;
        case NmeaSentence::zda:
            out.push_back(encode(Zda{talker_, r.time, r.date}, format_));
            return;
        default:
            return;
    }
}

Gga NmeaHandler::gga(const Report& r) const {
    Gga m;
    m.talker = talker_;
    m.time = r.time;
    m.position = r.position;
    m.quality = r.quality;
    m.hdop = no_dop;
    if (!r.position) return m;
    m.satellites_used = std::min(static_cast<int>(r.used.size()), max_listed_satellites_);
    m.hdop = r.fix.dop.hdop;
    m.altitude = above_sea_level(r.fix.position.height, r.fix.geoid_undulation).above_sea_level;
    m.geoid_separation = r.fix.geoid_undulation;
    // Corrections from SBAS come with no station of their own and an age that is not shown (capture in
    // RECEIVER.md 5.3).
    if (r.course_mode == NmeaMode::differential) m.correction_station = 0;
    return m;
}

void NmeaHandler::append_gsa(std::vector<std::string>& out, const Report& r) const {
    Gsa m;
    m.talker = talker_;
    m.fix_mode = r.fix_mode;
    m.pdop = m.hdop = m.vdop = no_dop;
    if (r.position) {
        m.pdop = r.fix.dop.pdop;
        m.hdop = r.fix.dop.hdop;
        m.vdop = r.fix.dop.vdop;
    }
    for (const NmeaSystem& system : systems_) {
        m.satellites.clear();
        m.system_id = system.system_id;
        for (const SatelliteStatus& s : r.used) {
            const auto number = nmea_satellite_number(s.id, format_.version, numbering_);
            if (number && nmea_system(s.id.constellation, format_.version) == system) m.satellites.push_back(*number);
        }
        out.push_back(encode(m, format_));
    }
}

void NmeaHandler::append_gsv(std::vector<std::string>& out, const Report& r) const {
    for (const NmeaSystem& system : systems_) {
        std::vector<GsvSatellite> listed;
        for (const SatelliteStatus& s : r.satellites) {
            if (nmea_system(s.id.constellation, format_.version) != system) continue;
            GsvSatellite line{nmea_satellite_number(s.id, format_.version, numbering_), whole_degrees(s.elevation),
                              (whole_degrees(s.azimuth) % 360 + 360) % 360, std::nullopt};
            if (s.cn0) line.cn0_dbhz = static_cast<int>(std::lround(std::clamp(s.cn0->value(), 0.0, 99.0)));
            listed.push_back(line);
        }
        const int signal_id = listed.empty() ? 0 : system.l1_signal_id;
        for (const Gsv& page : gsv_pages(std::string(system.talker), listed, signal_id))
            out.push_back(encode(page, format_));
    }
}

Gst NmeaHandler::gst(const Report& r) const {
    Gst m;
    m.talker = talker_;
    m.time = r.time;
    if (!r.position) return m;
    const double hdop = std::hypot(r.fix.dop.edop, r.fix.dop.ndop);
    const auto ellipse = error_ellipse(r.fix, r.used);
    if (ellipse) {
        m.range_rms = r.fix.horizontal_accuracy / hdop;
        m.semi_major = ellipse->semi_major;
        m.semi_minor = ellipse->semi_minor;
        m.orientation = ellipse->orientation;
        m.latitude = ellipse->north;
        m.longitude = ellipse->east;
    }
    m.altitude = r.fix.vertical_accuracy;
    return m;
}

}  // namespace skyloop::firmware
