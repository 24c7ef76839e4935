#include <fmt/format.h>

#include <algorithm>

#include "detail/text_track.hpp"
#include "receiver/logs/receiver_log.hpp"
#include "receiver/protocol/nmea_sentence.hpp"

namespace skyloop {
namespace {

TextRow nmea_row(const LogEpoch& epoch) {
    const LogMotion& motion = epoch.motion;
    TextRow row;
    row.time = epoch.time.time_since_epoch();
    if (motion.latitude && motion.longitude) {
        row.latitude_deg = motion.latitude->deg(), row.longitude_deg = motion.longitude->deg();
        if (motion.altitude) row.sea_level_m = motion.altitude->value();
        if (motion.separation) row.separation_m = motion.separation->value();
    } else {
        row.latitude_deg = epoch.place->latitude.deg(), row.longitude_deg = epoch.place->longitude.deg();
        row.ellipsoidal_m = epoch.place->height.above_ellipsoid.value();
    }
    if (motion.ground_speed) row.speed_mps = motion.ground_speed->value();
    if (motion.course) row.course_deg = motion.course->deg();
    if (motion.climb) row.climb_mps = motion.climb->value();
    if (motion.heading)
        row.attitude =
            Attitude::roll_pitch_yaw(motion.roll.value_or(Angle{}), motion.pitch.value_or(Angle{}), *motion.heading);
    return row;
}

bool nmea_has_place(const LogEpoch& epoch) { return epoch.place || (epoch.motion.latitude && epoch.motion.longitude); }

// Converters write places with the status of no fix; receivers repeat the last place so.
void add_nmea_epochs(TextTrack& track, const ReceiverLog& log) {
    const bool all_void = std::none_of(log.epochs.begin(), log.epochs.end(), [](const LogEpoch& epoch) {
        return nmea_has_place(epoch) && epoch.type != FixType::none;
    });
    // Zero everywhere is what programs write that do not know it (FEEDS.md 1.5).
    const bool separated = std::any_of(log.epochs.begin(), log.epochs.end(), [](const LogEpoch& epoch) {
        return epoch.motion.separation && epoch.motion.separation->value() != 0;
    });
    const bool heights = std::any_of(log.epochs.begin(), log.epochs.end(),
                                     [](const LogEpoch& epoch) { return epoch.motion.altitude.has_value(); });
    if (heights && !separated) track.note("the geoid's height above the ellipsoid is not told; it is that of EGM96");
    std::size_t marked = 0;
    for (const LogEpoch& epoch : log.epochs) {
        if (!nmea_has_place(epoch)) {
            track.leave_out("have no place", 0);
            continue;
        }
        if (epoch.type == FixType::none && !all_void) {
            track.leave_out("are marked as without a fix", 0);
            continue;
        }
        marked += epoch.type == FixType::none;
        TextRow row = nmea_row(epoch);
        if (!separated) row.separation_m.reset();
        if (!track.add(row)) track.leave_out("say a place or a speed that cannot be", 0);
    }
    if (marked > 0)
        track.note(fmt::format("all {} places are marked as without a fix; they are taken all the same", marked));
}

}  // namespace

bool is_nmea_track(const TrackFile& file) {
    constexpr std::size_t looked_at = 65536;
    TextLines lines(file.text.substr(0, looked_at));
    while (lines.next()) {
        const std::string_view line = lines.line();
        const std::size_t begin = line.find('$');
        if (begin == std::string_view::npos) continue;
        const auto sentence = parse_sentence(line.substr(begin));
        if (!sentence) continue;
        for (const std::string_view kind : {"RMC", "GGA", "GNS", "GLL", "GSA", "GSV", "VTG", "ZDA"})
            if (sentence->address.size() == 5 && sentence->address.ends_with(kind)) return true;
    }
    return false;
}

Result<Track> read_nmea_track(const TrackFile& file) {
    LogReading reading;
    reading.geoid = file.reading.geoid;
    reading.for_track = true;
    const auto log = read_receiver_log(file.bytes, file.name, reading);
    if (!log) return fail(log.error());
    TextTrack track(file, log->format, "epochs");
    for (const std::string& note : log->notes)
        track.note(note);
    if (!log->dated) {
        track.count_from_start();
        track.note("no date in it (no RMC or ZDA); times count from midnight of its first day");
    }
    const bool headings = std::any_of(log->epochs.begin(), log->epochs.end(),
                                      [](const LogEpoch& epoch) { return epoch.motion.heading && !epoch.motion.roll; });
    if (headings) track.note("headings (HDT, THS) come without roll and pitch, which are taken as level");
    add_nmea_epochs(track, *log);
    return track.finish("GGA, GNS or RMC sentences with a place");
}

}  // namespace skyloop
