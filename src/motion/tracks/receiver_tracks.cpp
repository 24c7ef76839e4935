// What receivers have said, as tracks.

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/core/words.hpp"
#include "detail/text_track.hpp"
#include "receiver/observed/observed_log.hpp"

namespace skyloop::inline motion {
namespace {

TextRow row_of(const ObservedEpoch& epoch) {
    const ObservedMotion& motion = epoch.motion;
    TextRow row;
    row.time = epoch.time.time_since_epoch();
    row.line = epoch.line;
    if (motion.latitude && motion.longitude) {
        row.latitude_deg = motion.latitude->deg(), row.longitude_deg = motion.longitude->deg();
        if (motion.altitude) row.sea_level_m = motion.altitude->value();
        if (motion.separation) row.separation_m = motion.separation->value();
    } else {
        row.latitude_deg = epoch.place->latitude.deg(), row.longitude_deg = epoch.place->longitude.deg();
        row.ellipsoidal_m = epoch.place->height.above_ellipsoid.value();
    }
    if (epoch.velocity)
        row.velocity = Velocity<Enu>(epoch.velocity->east, epoch.velocity->north, -epoch.velocity->down);
    if (motion.ground_speed) row.speed_mps = motion.ground_speed->value();
    if (motion.course) row.course_deg = motion.course->deg();
    if (motion.climb) row.climb_mps = motion.climb->value();
    row.attitude = epoch.attitude;
    if (motion.heading)
        row.attitude =
            Attitude::roll_pitch_yaw(motion.roll.value_or(Angle{}), motion.pitch.value_or(Angle{}), *motion.heading);
    return row;
}

bool has_place(const ObservedEpoch& epoch) { return epoch.place || (epoch.motion.latitude && epoch.motion.longitude); }

bool is_void(const ObservedEpoch& epoch) {
    return epoch.type == FixType::none || (epoch.type == FixType::time_only && !epoch.place);
}

// Converters write places with the status of no fix; receivers repeat the last place so.
void add_epochs(TextTrack& track, const ObservedLog& log) {
    const bool all_void = std::none_of(log.epochs.begin(), log.epochs.end(),
                                       [](const ObservedEpoch& epoch) { return has_place(epoch) && !is_void(epoch); });
    // Zero everywhere is what programs write that do not know it (FEEDS.md 1.5).
    const bool separated = std::any_of(log.epochs.begin(), log.epochs.end(), [](const ObservedEpoch& epoch) {
        return epoch.motion.separation && epoch.motion.separation->value() != 0;
    });
    std::size_t marked = 0;
    for (const ObservedEpoch& epoch : log.epochs) {
        if (!has_place(epoch)) {
            track.leave_out("have no place", epoch.line);
            continue;
        }
        if (is_void(epoch) && !all_void) {
            track.leave_out("are marked as without a fix", epoch.line);
            continue;
        }
        if (is_void(epoch)) ++marked;
        TextRow row = row_of(epoch);
        if (!separated) row.separation_m.reset();
        if (!track.add(row)) track.leave_out("say a place or a speed that cannot be", epoch.line);
    }
    if (marked > 0)
        track.note(fmt::format("all {} places are marked as without a fix; they are taken all the same", marked));
}

void add_notes(TextTrack& track, const ObservedLog& log) {
    const auto count = [&](auto&& is) { return std::count_if(log.epochs.begin(), log.epochs.end(), is); };
    const auto note = [&](std::ptrdiff_t number, const char* what) {
        if (number > 0) track.note(fmt::format("{} {}", number, what));
    };
    for (const std::string& told : log.notes)
        track.note(told);
    if (!log.dated) {
        track.count_from_start();
        track.note(log.format == "UBX"
                       ? "no week in it (no NAV-PVT, NAV-SOL or NAV-TIMEGPS); times count from its first week"
                       : "no date in it (no RMC or ZDA); times count from midnight of its first day");
    }
    if (count([](const ObservedEpoch& epoch) { return epoch.motion.heading && !epoch.motion.roll; }) > 0)
        track.note("headings (HDT, THS) come without roll and pitch, which are taken as level");
    const auto altitudes = count([](const ObservedEpoch& epoch) { return epoch.motion.altitude.has_value(); });
    const auto separations = count(
        [](const ObservedEpoch& epoch) { return epoch.motion.separation && epoch.motion.separation->value() != 0; });
    if (altitudes > 0 && separations == 0)
        track.note("the geoid's height above the ellipsoid is not told; it is that of EGM96");
    if (log.format == "NMEA") return;
    note(count([](const ObservedEpoch& epoch) { return epoch.type == FixType::fix_2d; }),
         "rows are fixes in two dimensions: their heights are not measured");
    note(count([](const ObservedEpoch& epoch) { return epoch.place && epoch.type == FixType::dead_reckoning; }),
         "rows were reckoned without satellites");
    note(count([](const ObservedEpoch& epoch) { return epoch.attitude.has_value(); }), "rows have an attitude");
}

}  // namespace

bool is_message_track(const TrackFile& file) { return holds_messages(file.bytes); }
bool is_solution_track(const TrackFile& file) { return is_rtklib_solution(file.bytes); }
bool is_sentence_track(const TrackFile& file) { return holds_sentences(file.bytes); }

Result<Track> read_observed_track(const TrackFile& file) {
    const auto log = read_observed(file.bytes, file.name, {file.reading.geoid, 0, ObservedUse::track});
    if (!log) return fail(log.error());
    TextTrack track(file, log->format, log->format == "RTKLIB solution" ? "rows" : "epochs");
    add_notes(track, *log);
    add_epochs(track, *log);
    return track.finish("NAV-PVT, PVTGeodetic, GGA, GNS or RMC with a place, or rows of a solution");
}

namespace {

// The log of Android's GnssLogger (gps-measurement-tools): lines of several kinds, of which Fix has the places. A
// comment names its columns, which changed over the versions; heights are above the ellipsoid
// (android.location.Location).
class GnssLoggerReader {
public:
    explicit GnssLoggerReader(const TrackFile& file) : track_(file, "GnssLogger", "fixes"), table_(file, ',', "") {}
    Result<Track> read();

private:
    // As many as a phone has: its receiver, its fusion with other sensors, its networks.
    static constexpr std::array<std::string_view, 3> providers{"gps", "flp", "nlp"};
    void take_names();
    Result<void> take_fix();
    [[nodiscard]] std::optional<std::size_t> column(std::string_view meaning) const;

    TextTrack track_;
    TableCells table_;
    std::vector<std::string> names_{"fix",   "provider", "latitude", "longitude", "altitude",
                                    "speed", "accuracy", "bearing",  "unixtime"};
    std::array<std::vector<TextRow>, providers.size()> rows_;
};

Result<Track> GnssLoggerReader::read() {
    while (table_.next()) {
        const std::string kind = lower_case(table_.cell(0));
        if (kind == "# fix" || kind == "#fix") take_names();
        if (kind != "fix") continue;
        if (const auto taken = take_fix(); !taken) return fail(taken.error());
    }
    bool taken = false;
    for (std::size_t i = 0; i < providers.size(); ++i) {
        if (rows_[i].empty()) continue;
        if (taken) {
            track_.note(
                fmt::format("{} fixes of the provider {} are not part of the path", rows_[i].size(), providers[i]));
            continue;
        }
        taken = true;
        if (i > 0) track_.note(fmt::format("no fixes of the receiver itself; those of {} are taken", providers[i]));
        for (const TextRow& row : rows_[i])
            if (const auto added = track_.add(row); !added) return fail(added.error());
    }
    return track_.finish("lines 'Fix,gps,…' with a time and a place");
}

void GnssLoggerReader::take_names() {
    names_.clear();
    for (const std::string_view cell : table_.cells())
        names_.push_back(lower_case(cell));
}

// The first column whose name begins so: "latitude" and "latitudedegrees" alike.
std::optional<std::size_t> GnssLoggerReader::column(std::string_view meaning) const {
    for (std::size_t i = 0; i < names_.size(); ++i)
        if (names_[i].starts_with(meaning)) return i;
    return std::nullopt;
}

Result<void> GnssLoggerReader::take_fix() {
    TextRow row;
    row.line = table_.line();
    const auto latitude = table_.coordinate(column("latitude"), Coordinate::latitude),
               longitude = table_.coordinate(column("longitude"), Coordinate::longitude);
    const auto altitude = table_.number(column("altitude")), speed = table_.number(column("speed"));
    const auto bearing = table_.number(column("bearing"));
    Result<std::optional<double>> millis = table_.number(column("unixtime"));
    if (millis && !*millis) millis = table_.number(column("(utc)time"));
    for (const auto& value : {latitude, longitude, altitude, speed, bearing, millis})
        if (!value) return fail(value.error());
    if (!*latitude || !*longitude) return track_.leave_out("have no place", row.line), Result<void>();
    const auto time = *millis ? posix_since_1980(fmt::format("{:.3f}", **millis / 1000)) : std::nullopt;
    if (!time) return track_.leave_out("have no time from 1980-01-06 to 2199", row.line), Result<void>();
    row.time = *time;
    row.latitude_deg = **latitude, row.longitude_deg = **longitude;
    row.ellipsoidal_m = *altitude;
    row.speed_mps = *speed;
    row.course_deg = *bearing;
    const std::string provider = lower_case(table_.cell(column("provider")));
    const std::size_t which = provider == "gps" ? 0 : provider == "nlp" || provider == "network" ? 2 : 1;
    rows_[which].push_back(row);
    return {};
}

}  // namespace

Result<Track> read_gnss_logger(const TrackFile& file) { return GnssLoggerReader(file).read(); }

}  // namespace skyloop::inline motion
