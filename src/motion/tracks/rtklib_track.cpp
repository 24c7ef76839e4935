#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "detail/table_cells.hpp"

namespace skyloop {
namespace {

// What the header of a solution says (RTKLIB manual 2.4.2, appendix B.1).
struct RtklibHeader {
    bool ecef = false, sexagesimal = false, sea_level = false, utc = false, jst = false, baseline = false;
};

bool names_rtklib_columns(std::string_view line) {
    return line.find("latitude(") != std::string_view::npos || line.find("x-ecef(") != std::string_view::npos ||
           line.find("-baseline(") != std::string_view::npos;
}

bool has_rtklib_header(std::string_view head) {
    TextLines lines(head);
    while (lines.next()) {
        const std::string_view line = trimmed_cell(lines.line());
        if (line.starts_with('%') && names_rtklib_columns(line)) return true;
        if (!line.empty() && !line.starts_with('%')) return false;
    }
    return false;
}

class RtklibRows {
public:
    explicit RtklibRows(const TrackFile& file) : file_(file), track_(file, "RTKLIB solution") {}
    Result<Track> read();

private:
    void take_header(std::string_view line);
    Result<void> take_row(std::string_view line, std::size_t number);
    std::optional<Nanoseconds> time();
    [[nodiscard]] std::optional<Nanoseconds> on_clock(const UtcTime& calendar) const;
    std::optional<double> next_number();
    std::optional<double> next_angle();
    bool place(TextRow& row);
    bool motion(TextRow& row);

    const TrackFile& file_;
    TextTrack track_;
    RtklibHeader header_;
    std::vector<std::string_view> cells_;
    std::size_t at_ = 0;
};

// Cells may be parted by commas and semicolons, too, as the options of RTKLIB say.
std::string blanked_rtklib_line(std::string_view line) {
    std::string blanked(line);
    std::replace_if(
        blanked.begin(), blanked.end(), [](char c) { return c == ',' || c == ';'; }, ' ');
    return blanked;
}

// A row as without a header it can be told: a time of two cells, degrees, a height, quality, satellites, six
// deviations, age and ratio.
bool is_bare_rtklib_row(std::string_view line) {
    constexpr std::size_t columns = 15, latest_week = 10'000, most_satellites = 200;
    const std::string blanked = blanked_rtklib_line(line);
    std::vector<std::string_view> cells;
    split_table_line(blanked, ' ', cells);
    if (cells.size() < columns) return false;
    const bool calendar = cells[0].size() == 10 && cells[0][4] == '/' && cells[0][7] == '/' &&
                          cells[1].find(':') != std::string_view::npos;
    std::vector<double> numbers;
    for (const std::string_view cell : std::span(cells).first(columns).subspan(calendar ? 2 : 0)) {
        const auto number = text_number(cell);
        if (!number) return false;
        numbers.push_back(*number);
    }
    const auto whole = [](double value, double least, double most) {
        return value >= least && value <= most && value == std::floor(value);
    };
    const std::span<const double> places = std::span(numbers).subspan(calendar ? 0 : 2);
    const bool weeks = whole(numbers[0], 1, latest_week) && numbers[1] >= 0 && numbers[1] < seconds_per_week;
    return (calendar || weeks) && std::abs(places[0]) <= 90 && std::abs(places[1]) <= 360 && whole(places[3], 1, 7) &&
           whole(places[4], 0, most_satellites);
}

Result<Track> RtklibRows::read() {
    TextLines lines(file_.text);
    if (!has_rtklib_header(file_.text)) track_.note("no header: taken as GPST, degrees, metres above the ellipsoid");
    while (lines.next()) {
        const std::string_view line = trimmed_cell(lines.line());
        if (line.starts_with('%')) {
            take_header(line);
            if (header_.baseline)
                return track_.refusal(lines.number(),
                                      "a solution of baselines; expected one of positions "
                                      "(out-solformat llh or xyz)");
        } else if (!line.empty()) {
            if (const auto taken = take_row(line, lines.number()); !taken) return fail(taken.error());
        }
    }
    return track_.finish("rows of a time and a place");
}

void RtklibRows::take_header(std::string_view line) {
    const auto says = [&](std::string_view what) { return line.find(what) != std::string_view::npos; };
    header_.sea_level |= says("height=WGS84/geodetic");
    if (!names_rtklib_columns(line)) return;
    header_.ecef = says("x-ecef(");
    header_.sexagesimal = says("latitude(d'");
    header_.baseline = says("-baseline(");
    header_.utc = says("UTC");
    header_.jst = says("JST");
}

std::optional<double> RtklibRows::next_number() {
    return at_ < cells_.size() ? text_number(cells_[at_++]) : std::nullopt;
}

std::optional<double> RtklibRows::next_angle() {
    const bool negative = at_ < cells_.size() && cells_[at_].starts_with('-');
    const auto degrees = next_number();
    if (!header_.sexagesimal || !degrees) return degrees;
    const auto minutes = next_number(), seconds = next_number();
    if (!minutes || !seconds) return std::nullopt;
    const double size = std::abs(*degrees) + *minutes / 60 + *seconds / 3600;
    return negative ? -size : size;
}

std::optional<Nanoseconds> RtklibRows::on_clock(const UtcTime& calendar) const {
    if (!is_calendar_time(calendar)) return std::nullopt;
    const Nanoseconds utc = to_gps_time(calendar, LeapSeconds::announced()).time_since_epoch();
    if (header_.utc) return utc;
    if (header_.jst) return utc - std::chrono::hours(9);
    const Nanoseconds gps =
        gps_calendar_time(calendar.year, calendar.month, calendar.day, calendar.hour, calendar.minute, calendar.second)
            .time_since_epoch();
    return gps + Nanoseconds(calendar.nanosecond);
}

// "2018/10/15 17:00:00.000", or a GPS week and the time of week.
std::optional<Nanoseconds> RtklibRows::time() {
    if (cells_.size() < 2) return std::nullopt;
    const std::string_view first = cells_[0], second = cells_[1];
    at_ = 2;
    if (first.find('/') != std::string_view::npos) {
        std::string text = fmt::format("{:.20}T{:.20}Z", first, second);
        std::replace(text.begin(), text.end(), '/', '-');
        const auto calendar = parse_utc(text);
        return calendar ? on_clock(*calendar) : std::nullopt;
    }
    const auto week = text_number(first), tow = text_number(second);
    if (!week || !tow) return std::nullopt;
    const auto gps = week_since_1980(*week, *tow);
    // The calendar of a clock that runs behind GPST is read as that clock's.
    return gps && (header_.utc || header_.jst) ? on_clock(gps_calendar(GpsTime(*gps))) : gps;
}

bool RtklibRows::place(TextRow& row) {
    const auto a = header_.ecef ? next_number() : next_angle(), b = header_.ecef ? next_number() : next_angle(),
               c = next_number();
    if (!a || !b || !c) return false;
    if (header_.ecef) {
        row.position = Position<Ecef>(*a, *b, *c);
        return true;
    }
    row.latitude_deg = *a, row.longitude_deg = *b;
    (header_.sea_level ? row.sea_level_m : row.ellipsoidal_m) = *c;
    return true;
}

// After quality, satellites, six deviations, age and ratio: velocities north, east and up, where they were asked for.
bool RtklibRows::motion(TextRow& row) {
    constexpr std::size_t before = 8, with_velocity = before + 3;
    const auto quality = next_number(), satellites = next_number();
    if (!quality || !satellites) return false;
    if (header_.ecef || cells_.size() < at_ + with_velocity) return true;
    at_ += before;
    const auto north = next_number(), east = next_number(), up = next_number();
    if (north && east && up) row.velocity = Velocity<Enu>(*east, *north, *up);
    return true;
}

Result<void> RtklibRows::take_row(std::string_view line, std::size_t number) {
    const std::string blanked = blanked_rtklib_line(line);
    split_table_line(blanked, ' ', cells_);
    TextRow row;
    row.line = number;
    const auto when = time();
    if (!when)
        return track_.refusal(number,
                              fmt::format("the time is '{:.40}'; expected e.g. 2018/10/15 17:00:00.000, or a GPS "
                                          "week and the time of week",
                                          line));
    row.time = *when;
    if (!place(row) || !motion(row))
        return track_.refusal(number, "cells are missing or no numbers; expected a time, a place, quality, satellites");
    return track_.add(row);
}

}  // namespace

bool is_rtklib_track(std::string_view head) {
    if (has_rtklib_header(head)) return true;
    TextLines lines(head);
    while (lines.next()) {
        const std::string_view line = trimmed_cell(lines.line());
        if (!line.empty() && !line.starts_with('%')) return is_bare_rtklib_row(line);
    }
    return false;
}

Result<Track> read_rtklib_track(const TrackFile& file) { return RtklibRows(file).read(); }

}  // namespace skyloop
