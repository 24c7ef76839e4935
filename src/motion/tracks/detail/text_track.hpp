// Rows as files of text tell them, and how a track is made of them.
// Rows of tables whose columns a dialect knows by their places or names.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/table_text.hpp"
#include "base/core/written_place.hpp"
#include "base/geo/local_frame.hpp"
#include "base/time/utc_time.hpp"
#include "track_formats.hpp"

namespace skyloop::inline motion {

// One row of a text file: what is absent there is absent here.
struct TextRow {
    Nanoseconds time{0};  // since 1980-01-06 (GPS time), or since the file's own start
    std::size_t line = 0;
    bool jump = false;  // the source says that it begins anew here
    bool timed = true;
    double latitude_deg = 0, longitude_deg = 0;
    std::optional<double> ellipsoidal_m;     // height above the ellipsoid
    std::optional<double> sea_level_m;       // height above mean sea level
    std::optional<double> separation_m;      // of the geoid above the ellipsoid, as the file tells it
    std::optional<Position<Ecef>> position;  // instead of latitude, longitude and height
    std::optional<double> speed_mps;         // over ground
    std::optional<double> course_deg;        // over ground, from true north
    std::optional<double> climb_mps;
    std::optional<Velocity<Enu>> velocity;  // instead of speed, course and climb
    std::optional<Attitude> attitude;
};

// The number that the whole of a cell is, with a decimal point and without blanks around it; nothing for anything else.
std::optional<double> text_number(std::string_view text);
// Line ends and other control characters as blanks: what a file holds does not break a message.
std::string one_line_of(std::string text);

// Lines of a text, one after the other, with their numbers; a byte order mark before the first is left out.
class TextLines {
public:
    explicit TextLines(std::string_view text) : rest_(text.starts_with("\xEF\xBB\xBF") ? text.substr(3) : text) {}
    // False after the last one. Lines longer than 64 KiB are cut there: no format has such.
    bool next();
    [[nodiscard]] std::string_view line() const { return line_; }  // without its end
    [[nodiscard]] std::size_t number() const { return number_; }   // from 1

private:
    std::string_view rest_, line_;
    std::size_t number_ = 0;
};

// An instant as ISO 8601 writes it: 2024-03-05T12:00:00.123456789Z, with any zone, or none.
struct IsoTime {
    GpsTime time;
    bool zoned = false;     // says its zone; else UTC is taken
    bool in_range = false;  // of GpsTime: 1980-01-06 to 2199; `time` means nothing outside
};
// `T` may be a blank, seconds may be absent, the zone Z, +01:00, +0100, +01 or absent, the fraction of any length;
// beyond the ninth digit it is cut. Nothing for any other text.
std::optional<IsoTime> parse_iso_time(std::string_view text);

// GPS time of a calendar in UTC, or nothing outside 1980-01-06 … 2199 and for what is no calendar time.
std::optional<Nanoseconds> utc_since_1980(const UtcTime& utc);

// The attitude of a body with axes forward, left, up that is turned so in axes east, north, up.
Attitude attitude_of_flu_in_enu(const Eigen::Quaterniond& body_to_enu);

// Gathers rows and makes the track of them: heights above the ellipsoid, velocities of speed and course, what is left
// out and why. Rows come in parts: tracks of one file, of which those overlapping a longer one in time are left out.
class TextTrack {
public:
    // @param format for people: "GPX 1.1"
    TextTrack(const TrackFile& file, std::string format, std::string rows_called = "rows");

    void set_format(std::string format) { track_.format = std::move(format); }
    // A track of several in the file begins; its first row is a jump.
    void begin_part(std::string_view name);
    // Fails where latitude, longitude, height or speed cannot be.
    Result<void> add(TextRow row);
    // A row whose time is missing or cannot be. Where hardly any row has one, the rows are a route in the order of the
    // file; else it is left out. @param why as of leave_out()
    // @param time as it stands in the file, empty where there is none
    Result<void> add_untimed(TextRow row, std::string_view why, std::string_view time = {});
    // A row that is not taken. @param why continues "3 of 10 rows …": "have no time"
    void leave_out(std::string_view why, std::size_t line);
    void note(std::string text);
    // The times of the rows count from the file's own start.
    void count_from_start() { absolute_ = false; }
    [[nodiscard]] const std::optional<Geodetic>& origin() const { return file_.reading.origin; }
    [[nodiscard]] std::size_t rows() const { return taken_ + untimed_.size() + left_out_count_; }
    [[nodiscard]] std::size_t taken() const { return taken_; }
    [[nodiscard]] tl::unexpected<Error> refusal(std::size_t line, const std::string& what) const;
    [[nodiscard]] tl::unexpected<Error> refusal(const std::string& what) const;
    // @param expected what a file of this format should hold, for the error when no row is left
    Result<Track> finish(std::string_view expected);

private:
    struct Part {
        std::string name;
        std::vector<TextRow> rows;
    };
    struct LeftOut {
        std::string why;
        std::size_t count = 0, first_line = 0;
    };
    struct Untimed {
        std::string why;
        std::size_t line = 0;
    };
    [[nodiscard]] Result<void> check(TextRow& row) const;
    void settle_untimed();
    void make_route();
    [[nodiscard]] std::string why_no_times() const;
    [[nodiscard]] double along(std::size_t i) const;
    void merge_parts();
    void drop_zero_places();
    Result<void> resolve_heights();
    void fill_heights();
    void place_rows();
    void add_velocities();
    [[nodiscard]] std::string told_left_out(const LeftOut& out) const;
    void tell_velocities();

    const TrackFile& file_;
    std::string rows_called_;
    Track track_;
    bool absolute_ = true;
    std::vector<Part> parts_;
    std::vector<TextRow> rows_;
    std::vector<LeftOut> left_out_;
    std::vector<Untimed> untimed_;
    std::map<std::string, std::size_t, std::less<>> unusable_times_;  // as they stand, and how often
    std::size_t taken_ = 0, left_out_count_ = 0;
};

// Lines of cells, without empty lines and comments.
class TableCells {
public:
    // @param comments characters that begin one
    TableCells(const TrackFile& file, char separator, std::string_view comments)
        : name_(file.name), lines_(file.text), separator_(separator), comments_(comments) {}
    bool next();
    [[nodiscard]] const std::vector<std::string_view>& cells() const { return cells_; }
    [[nodiscard]] std::string_view text() const { return lines_.line(); }
    [[nodiscard]] std::size_t line() const { return lines_.number(); }
    // Takes the present line as the names of the columns.
    void take_names();
    // Fails where the row has more cells than there are names: a decimal comma made two of one.
    [[nodiscard]] Result<void> check_width() const;
    [[nodiscard]] const std::vector<std::string>& names() const { return names_; }  // in lower case
    // Of the column with this name, letters of either case; nothing: there is none.
    [[nodiscard]] std::optional<std::size_t> column(std::string_view name) const;
    // Empty where the row has fewer cells or the column is not there.
    [[nodiscard]] std::string_view cell(std::optional<std::size_t> column) const;
    // Nothing for an empty cell and for "nan". Fails with NAME:LINE and the column for any other text.
    Result<std::optional<double>> number(std::optional<std::size_t> column) const;
    // The same of a latitude or longitude, whose cell may have a letter, minutes and seconds.
    Result<std::optional<double>> coordinate(std::optional<std::size_t> column, Coordinate which) const;
    // Latitude and longitude of the columns with these names, by the letters of the row too; nothing where one of them
    // is absent. All rows of a table are asked with the same names.
    Result<std::optional<std::array<double, 2>>> place(std::array<std::string_view, 2> names);
    [[nodiscard]] const HemisphereColumns& hemispheres() const { return hemispheres_; }
    // Cells from `first` on, all of them numbers.
    Result<std::vector<double>> numbers(std::size_t first, std::size_t count) const;
    [[nodiscard]] tl::unexpected<Error> refusal(const std::string& what) const;

private:
    const std::string& name_;
    TextLines lines_;
    char separator_;
    std::string comments_;
    std::vector<std::string> names_;  // in lower case
    std::vector<std::string_view> cells_;
    std::optional<std::array<std::size_t, 2>> places_;
    HemisphereColumns hemispheres_;
};

// Nanoseconds since 1980 of POSIX seconds written with a fraction, to the digit; nothing outside GPS time.
std::optional<Nanoseconds> posix_since_1980(std::string_view seconds);
// Nanoseconds since 1980 of a GPS week and the time of week, s; nothing outside.
std::optional<Nanoseconds> week_since_1980(double week, double tow_s);

// Tables that are told by the names in their header.
bool is_named_dialect(std::string_view head);
Result<Track> read_named_dialect(const TrackFile& file);
Result<Track> read_gnss_logger(const TrackFile& file);
// Tables without a header, told by the shape of their rows.
bool is_shaped_dialect(const TrackFile& file);
Result<Track> read_shaped_dialect(const TrackFile& file);

}  // namespace skyloop::inline motion
