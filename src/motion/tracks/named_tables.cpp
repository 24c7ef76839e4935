// Tables that programs and receivers write with names of their own over the columns.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "base/core/number_text.hpp"
#include "base/core/table_text.hpp"
#include "base/core/words.hpp"
#include "detail/text_track.hpp"

namespace skyloop::inline motion {
namespace {

constexpr double named_foot = 0.3048, named_knot = 1852.0 / 3600;

// Columns of a row by name, each absent one as nothing. After a failure all that follows is nothing.
class NamedRow {
public:
    explicit NamedRow(const TableCells& table) : table_(table) {}
    std::optional<double> number(std::string_view name, double scale = 1) {
        if (fault_ || name.empty()) return std::nullopt;
        const auto value = table_.number(table_.column(name));
        if (!value) fault_ = value.error();
        return value && *value ? std::optional(**value * scale) : std::nullopt;
    }
    [[nodiscard]] std::string_view text(std::string_view name) const { return table_.cell(table_.column(name)); }
    [[nodiscard]] tl::unexpected<Error> refusal(const std::string& what) const { return table_.refusal(what); }
    [[nodiscard]] const std::optional<Error>& fault() const { return fault_; }

private:
    const TableCells& table_;
    std::optional<Error> fault_;
};

// A dialect: its rows one by one.
using RowTaker = std::function<Result<void>(TextTrack&, TableCells&)>;

// What a dialect tells in a row beside the place; false: the row is left out.
using NamedRowReader = std::function<Result<bool>(TextTrack&, NamedRow&, TextRow&)>;

// Rows with latitude and longitude in columns of these names.
RowTaker named_rows(const std::array<std::string_view, 2>& places, NamedRowReader read) {
    return [places, read = std::move(read)](TextTrack& track, TableCells& table) -> Result<void> {
        if (auto fits = table.check_width(); !fits) return fits;
        NamedRow columns(table);
        TextRow row;
        row.line = table.line();
        const auto taken = read(track, columns, row);
        if (!taken) return fail(taken.error());
        if (!*taken) return {};
        const auto place = table.place(places);
        if (!place) return fail(place.error());
        if (!*place) return track.leave_out("have no place", row.line), Result<void>();
        row.latitude_deg = (**place)[0], row.longitude_deg = (**place)[1];
        if (columns.fault()) return fail(*columns.fault());
        return track.add(row);
    };
}

// Garmin G1000 (the file's own lines of units): local time and its offset from UTC; AltGPS, feet above WGS 84; ground
// track and heading from magnetic north, MagVar their variation, east positive; vertical speed in feet a minute.
Result<bool> read_g1000_row(TextTrack& track, NamedRow& columns, TextRow& row) {
    const std::string_view date = columns.text("Lcl Date"), clock = columns.text("Lcl Time");
    if (date.empty() || clock.empty()) return track.leave_out("have no time", row.line), false;
    const auto time = parse_iso_time(fmt::format("{:.20} {:.20}{:.10}", date, clock, columns.text("UTCOfst")));
    if (!time || !time->in_range)
        return columns.refusal(
            fmt::format("the time is '{:.20} {:.20} {:.10}'; expected one as 2014-03-29, 22:50:22, "
                        "+00:00",
                        date, clock, columns.text("UTCOfst")));
    row.time = time->time.time_since_epoch();
    row.ellipsoidal_m = columns.number("AltGPS", named_foot);
    if (!row.ellipsoidal_m) row.sea_level_m = columns.number("AltMSL", named_foot);
    row.speed_mps = columns.number("GndSpd", named_knot);
    row.climb_mps = columns.number("VSpdG", named_foot / 60);
    const auto variation = columns.number("MagVar"), course = columns.number("TRK"), heading = columns.number("HDG");
    const auto roll = columns.number("Roll"), pitch = columns.number("Pitch");
    if (variation && course) row.course_deg = *course + *variation;
    if (variation && heading && roll && pitch)
        row.attitude = Attitude::roll_pitch_yaw(Angle::degrees(*roll), Angle::degrees(*pitch),
                                                Angle::degrees(*heading + *variation));
    return true;
}

// The table of Hazer's gpstool (com-diag-hazer, yodel): TIM, POSIX seconds of the fix; MSL and GEO, metres above sea
// level and above the ellipsoid; SOG in knots, COG from true north.
Result<bool> read_yodel_row(TextTrack& track, NamedRow& columns, TextRow& row) {
    const auto fix = columns.number("FIX");
    if (fix && *fix < 2) return track.leave_out("have a fix below 2", row.line), false;
    const auto time = posix_since_1980(columns.text("TIM"));
    if (!time) return columns.refusal(fmt::format("TIM is '{:.40}'; expected POSIX seconds", columns.text("TIM")));
    row.time = *time;
    row.ellipsoidal_m = columns.number("GEO");
    if (!row.ellipsoidal_m) row.sea_level_m = columns.number("MSL");
    row.speed_mps = columns.number("SOG", named_knot);
    row.course_deg = columns.number("COG");
    return true;
}

// What columns of unicsv are called that may tell a unit: "Altitude", "Altitude (ft)" or "alt_ft".
struct UnicsvQuantity {
    std::array<std::string_view, 4> names;
    Measured measured;
};
constexpr UnicsvQuantity unicsv_altitude{{"altitude", "alt", "elevation", "ele"}, Measured::length},
    unicsv_speed{{"speed", "ground_speed"}, Measured::speed}, unicsv_course{{"course"}, Measured::angle};

// What the numbers of a column are multiplied by when it says this quantity.
std::optional<double> unicsv_scale(std::string_view column, const UnicsvQuantity& quantity) {
    const auto is_one = [&](const std::string& name) {
        return !name.empty() && std::find(quantity.names.begin(), quantity.names.end(), name) != quantity.names.end();
    };
    const ColumnName bracketed = bracketed_column_name(column), behind = column_name(column);
    if (is_one(bracketed.name))
        return bracketed.unit.empty() ? std::optional(1.0) : unit_scale(bracketed.unit, quantity.measured);
    return is_one(behind.name) ? unit_scale(behind.unit, quantity.measured) : std::nullopt;
}

// Where a quantity stands; an empty name: nowhere.
struct UnicsvColumn {
    std::string name;
    double scale = 1;
};
struct UnicsvColumns {
    UnicsvColumn altitude, speed, course;
};

UnicsvColumn unicsv_column(const std::vector<std::string>& names, const UnicsvQuantity& quantity) {
    for (const std::string& name : names)
        if (const auto scale = unicsv_scale(name, quantity)) return {name, *scale};
    return {};
}

// gpsbabel's unicsv: date and time in UTC in two columns, metres above sea level, m/s. Tables of others that have its
// names may tell other units behind them.
Result<bool> read_unicsv_row(const UnicsvColumns& told, TextTrack& track, NamedRow& columns, TextRow& row) {
    const std::string_view date = columns.text("Date"), clock = columns.text("Time");
    if (date.empty() || clock.empty()) return track.leave_out("have no time", row.line), false;
    const auto time = parse_iso_time(fmt::format("{:.20} {:.20}", date, clock));
    if (!time)
        return columns.refusal(
            fmt::format("the time is '{:.20} {:.20}'; expected one as 2024/03/05, 12:00:00.25", date, clock));
    if (!time->in_range) return track.leave_out("have a time before 1980-01-06 or after 2199", row.line), false;
    row.time = time->time.time_since_epoch();
    row.sea_level_m = columns.number(told.altitude.name, told.altitude.scale);
    row.speed_mps = columns.number(told.speed.name, told.speed.scale);
    row.course_deg = columns.number(told.course.name, told.course.scale);
    return true;
}

// Names that gpsbabel writes and that say nothing of the way, and those that are read.
bool is_unicsv_name(const std::string& text) {
    static constexpr std::array<std::string_view, 27> plain{
        "no",          "name",       "description", "symbol",    "date",    "time",      "latitude",
        "longitude",   "notes",      "note",        "url",       "depth",   "comment",   "proximity",
        "fix",         "satellites", "hdop",        "vdop",      "pdop",    "heartrate", "cadence",
        "temperature", "power",      "geoidheight", "container", "terrain", "type"};
    return std::find(plain.begin(), plain.end(), text) != plain.end() || unicsv_scale(text, unicsv_altitude) ||
           unicsv_scale(text, unicsv_speed) || unicsv_scale(text, unicsv_course);
}

// Nanoseconds since 1980 of a whole count of POSIX nanoseconds, which a double cannot hold.
std::optional<Nanoseconds> posix_nanoseconds(std::string_view text) {
    const auto count = number_in<std::int64_t>(text);
    constexpr std::int64_t second = 1'000'000'000;
    if (!count || *count < gps_epoch_posix_s * second || *count >= 7'258'118'400 * second) return std::nullopt;
    return from_posix(Nanoseconds(*count), LeapSeconds::announced()).time_since_epoch();
}

// The ground truth of EuRoC (its README): POSIX nanoseconds, place in a room, m, whose axes it takes z up; the columns
// that follow are of an inertial sensor with axes of its own.
Result<void> take_euroc_row(TextTrack& track, TableCells& table) {
    TextRow row;
    row.line = table.line();
    const auto time = posix_nanoseconds(table.cell(0));
    if (!time) return table.refusal(fmt::format("the time is '{:.40}'; expected POSIX nanoseconds", table.cell(0)));
    row.time = *time;
    const auto place = table.numbers(1, 3);
    if (!place) return fail(place.error());
    row.position = LocalFrame(*track.origin()).to_ecef(Position<Enu>((*place)[0], (*place)[1], (*place)[2]));
    return track.add(row);
}

// Whether the second column of EuRoC's names is that of a place: "p_RS_R_x [m]", or "x" in copies. Its inertial sensors
// have turn rates there.
bool euroc_names_tell_places(std::string_view names) {
    std::vector<std::string_view> cells;
    split_table_line(names, ',', cells);
    const std::string second = cells.size() > 1 ? lower_case(trimmed_cell(cells[1])) : std::string();
    return second.starts_with("p_rs_r_x") || second == "x" || second.starts_with("x [");
}

// The line with the names of EuRoC's columns; empty: none. The ground truth says "#timestamp" alone, which others may
// say, too; all else in EuRoC's folders "#timestamp [ns]".
std::string_view euroc_names(std::string_view text) {
    constexpr std::size_t looked_at = 65536;
    TextLines lines(text.substr(0, looked_at));
    while (lines.next()) {
        const std::string_view line = trimmed_cell(lines.line());
        const std::string lowered = lower_case(line.substr(0, 20));
        if (lowered.starts_with("#timestamp [ns],") ||
            (lowered.starts_with("#timestamp,") && euroc_names_tell_places(line)))
            return line;
    }
    return {};
}

// A table whose line of names is the first that begins so.
// @param unused names of columns that the dialect does not know
Result<Track> read_rows(const TrackFile& file, TextTrack& track, const RowTaker& take, std::string_view names_begin,
                        std::vector<std::string> unused = {}) {
    TableCells table(file, names_begin.empty() ? ',' : separator_in(names_begin), "");
    bool named = false;
    while (table.next()) {
        if (!named) {
            named = lower_case(trimmed_cell(table.text())).starts_with(lower_case(names_begin));
            if (named) table.take_names();
            continue;
        }
        if (const auto taken = take(track, table); !taken) return fail(taken.error());
    }
    if (const auto letters = table.hemispheres().not_understood()) return track.refusal(*letters);
    for (const std::string& note : table.hemispheres().notes(std::move(unused)))
        track.note(note);
    return track.finish("rows with a time and a place");
}

Result<Track> read_g1000(const TrackFile& file) {
    TextTrack track(file, "Garmin G1000");
    return read_rows(file, track, named_rows({"Latitude", "Longitude"}, read_g1000_row), "Lcl Date,");
}

Result<Track> read_yodel(const TrackFile& file) {
    TextTrack track(file, "Hazer");
    track.note("roll, pitch and yaw are not read: the rows do not say which of them are known");
    return read_rows(file, track, named_rows({"LAT", "LON"}, read_yodel_row), "NAM,");
}

Result<Track> read_euroc(const TrackFile& file) {
    TextTrack track(file, "EuRoC");
    if (!file.reading.origin)
        return track.refusal(
            "local metres (EuRoC); expected trajectory.origin = [latitude, longitude, height], where "
            "they begin");
    track.note(
        "local metres are taken as east, north, up; attitude is not read: it is that of a sensor with axes of its "
        "own");
    const std::string_view names = euroc_names(file.text);
    if (!euroc_names_tell_places(names))
        return track.refusal(fmt::format(
            "no places (EuRoC, '{:.40}'); expected p_RS_R_x, p_RS_R_y and p_RS_R_z behind the time", names));
    return read_rows(file, track, take_euroc_row, names);
}

// The line with the names of unicsv's columns; empty: none of the first ones is.
std::string_view unicsv_names(std::string_view head) {
    TextLines lines(head);
    while (lines.next()) {
        const std::string_view line = lines.line();
        if (trimmed_cell(line).empty()) continue;
        std::vector<std::string_view> cells;
        split_table_line(line, separator_in(line), cells);
        std::size_t found = 0;
        for (const std::string_view cell : cells)
            for (const std::string_view name : {"latitude", "longitude", "date", "time"})
                found += lower_case(cell) == name;
        return found == 4 ? trimmed_cell(line) : std::string_view();
    }
    return {};
}

// A column that says a height in a way that is not unicsv's; the path would lie at sea level.
bool is_other_height(const std::string& name) {
    return name.starts_with("alt") || name.starts_with("ele") || name.starts_with("height");
}

Result<Track> read_unicsv(const TrackFile& file) {
    constexpr std::size_t looked_at = 65536;
    TextTrack track(file, "unicsv");
    const std::string_view names = unicsv_names(file.text.substr(0, looked_at));
    std::vector<std::string_view> cells;
    split_table_line(names, separator_in(names), cells);
    std::vector<std::string> all, unused;
    for (const std::string_view cell : cells) {
        all.push_back(lower_case(cell));
        if (!is_unicsv_name(all.back()) && !all.back().empty()) unused.push_back(all.back());
    }
    const UnicsvColumns columns{unicsv_column(all, unicsv_altitude), unicsv_column(all, unicsv_speed),
                                unicsv_column(all, unicsv_course)};
    const auto other = std::find_if(unused.begin(), unused.end(), is_other_height);
    if (columns.altitude.name.empty() && other != unused.end())
        return track.refusal(
            fmt::format("the column '{:.40}' is not known; expected Altitude, or Altitude (ft)", *other));
    const auto take = named_rows({"Latitude", "Longitude"}, [&](TextTrack& to, NamedRow& row_columns, TextRow& row) {
        return read_unicsv_row(columns, to, row_columns, row);
    });
    return read_rows(file, track, take, names, std::move(unused));
}

// Whether one of the first lines begins so, letters of either case.
bool has_line(std::string_view head, std::string_view begin) {
    TextLines lines(head);
    while (lines.next())
        if (lower_case(trimmed_cell(lines.line()).substr(0, begin.size())) == lower_case(begin)) return true;
    return false;
}

struct NamedDialect {
    bool (*fits)(std::string_view head);
    Result<Track> (*read)(const TrackFile&);
};

constexpr std::array named_dialects{
    NamedDialect{[](std::string_view head) { return has_line(head, "# Fix,") || has_line(head, "Fix,"); },
                 read_gnss_logger},
    NamedDialect{[](std::string_view head) { return has_line(head, "Lcl Date,"); }, read_g1000},
    NamedDialect{[](std::string_view head) { return has_line(head, "NAM, NUM, FIX,"); }, read_yodel},
    NamedDialect{[](std::string_view head) { return !euroc_names(head).empty(); }, read_euroc},
    NamedDialect{[](std::string_view head) { return !unicsv_names(head).empty(); }, read_unicsv}};

}  // namespace

bool is_named_dialect(std::string_view head) {
    return std::any_of(named_dialects.begin(), named_dialects.end(),
                       [&](const NamedDialect& dialect) { return dialect.fits(head); });
}

Result<Track> read_named_dialect(const TrackFile& file) {
    constexpr std::size_t looked_at = 65536;
    for (const NamedDialect& dialect : named_dialects)
        if (dialect.fits(file.text.substr(0, looked_at))) return dialect.read(file);
    return TextTrack(file, "CSV").refusal("no table of a known form");
}

}  // namespace skyloop::inline motion
