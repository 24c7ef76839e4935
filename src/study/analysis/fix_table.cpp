#include "detail/run_tables.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/core/words.hpp"
#include "base/time/utc_time.hpp"
#include "world/flow/fix.hpp"

namespace skyloop::inline study {
namespace {

// No aircraft, no satellite that carries a GNSS receiver is higher, m.
constexpr double highest_height = 1e8;

// One line of the table and what a message needs to know about it.
struct TableRow {
    const std::string& file;
    std::size_t line = 0;
    std::vector<std::string_view> cells;

    [[nodiscard]] Error error(const std::string& what) const {
        return {ErrorCode::input, fmt::format("{}:{}: {}", file, line, what)};
    }
};

// What a message may quote of a cell that can be anything.
std::string_view quotable(std::string_view text) { return text.substr(0, 40); }

Result<double> cell_number(const TableRow& row, const FixColumn& column, std::string_view what) {
    const std::string_view cell = row.cells[column.index];
    const std::optional<double> value = cell_value(cell);
    if (!value || !std::isfinite(*value))
        return fail(row.error(
            fmt::format("column {}: the {} is '{}'; expected a number", column.index + 1, what, quotable(cell))));
    return *value * column.scale;
}

// Latitude and longitude in degrees, by the letters of the row too.
Result<std::array<double, 2>> place_of_row(const TableRow& row, FixColumns& columns) {
    std::array<double, 2> place{};
    for (const Coordinate which : {Coordinate::latitude, Coordinate::longitude}) {
        const bool latitude = which == Coordinate::latitude;
        const FixColumn& column = latitude ? columns.latitude : columns.longitude;
        const auto written = cell_value(row.cells[column.index]) || column.scale != 1
                                 ? std::nullopt
                                 : written_degrees(row.cells[column.index], which);
        const Result<double> number =
            written ? *written : cell_number(row, column, latitude ? "latitude" : "longitude");
        if (!number) return fail(number.error());
        place.at(static_cast<std::size_t>(which)) = *number;
    }
    const auto sided = columns.hemispheres.place(row.cells, place, row.line);
    if (!sided) return fail(row.error(sided.error()));
    return *sided;
}

Result<Geodetic> estimate_at(const TableRow& row, FixColumns& columns) {
    const auto place = place_of_row(row, columns);
    if (!place) return fail(place.error());
    const Result<double> h = cell_number(row, columns.height, "height");
    if (!h) return fail(h.error());
    const auto position = checked_position((*place)[0], (*place)[1], *h);
    if (!position) return fail(row.error(position.error()));
    return *position;
}

Result<Geodetic> position_at(const TableRow& row, const FixColumn& latitude, const FixColumn& longitude,
                             const FixColumn& height) {
    const Result<double> lat = cell_number(row, latitude, "latitude");
    if (!lat) return fail(lat.error());
    const Result<double> lon = cell_number(row, longitude, "longitude");
    if (!lon) return fail(lon.error());
    const Result<double> h = cell_number(row, height, "height");
    if (!h) return fail(h.error());
    const auto position = checked_position(*lat, *lon, *h);
    if (!position) return fail(row.error(position.error()));
    return *position;
}

// Rows that a warning counts.
struct TableCounts {
    std::size_t partial = 0, zero = 0;
};

// Whether a row without a fix type is a fix: it has a whole place, which is not where what is not known is put.
bool row_has_place(const TableRow& row, const FixColumns& columns, TableCounts& counts) {
    std::size_t empty = 0;
    for (const FixColumn& column : {columns.latitude, columns.longitude, columns.height})
        if (is_absent(row.cells[column.index])) ++empty;
    constexpr std::size_t whole = 3;
    if (empty > 0 && empty < whole) ++counts.partial;
    if (empty > 0) return false;
    const bool zero =
        cell_value(row.cells[columns.latitude.index]) == 0.0 && cell_value(row.cells[columns.longitude.index]) == 0.0;
    if (zero) ++counts.zero;
    return !zero;
}

// By the fix_type, where there is one.
Result<bool> row_has_fix(const TableRow& row, const FixColumns& columns, TableCounts& counts) {
    if (!columns.fix_type) return row_has_place(row, columns, counts);
    const std::string_view cell = row.cells[columns.fix_type->index];
    if (std::find(fix_type_names.begin(), fix_type_names.end(), cell) != fix_type_names.end())
        return cell != fix_type_name(FixType::none) && cell != fix_type_name(FixType::time_only);
    return fail(row.error(fmt::format("fix_type is '{}'; expected one of {}{}", quotable(cell),
                                      fmt::join(fix_type_names, ", "), did_you_mean(cell, fix_type_names))));
}

// ISO 8601 dates a row; a bare number of seconds only tells rows apart.
Result<std::optional<GpsTime>> row_time(const TableRow& row, const FixColumns& columns, bool& dated) {
    if (columns.week && columns.tow) {
        const Result<double> week = cell_number(row, *columns.week, "GPS week");
        if (!week) return fail(week.error());
        const Result<double> tow = cell_number(row, *columns.tow, "time of week");
        if (!tow) return fail(tow.error());
        if (*week < 0 || *week > static_cast<double>(last_gps_week) || *tow < 0 ||
            *tow > static_cast<double>(seconds_per_week))
            return fail(row.error(fmt::format("GPS week {} and time of week {} s are out of range", *week, *tow)));
        dated = true;
        return to_gps_time(static_cast<std::int64_t>(*week), *tow);
    }
    if (!columns.time || row.cells[columns.time->index].empty()) return std::optional<GpsTime>();
    const std::string_view cell = row.cells[columns.time->index];
    constexpr double longest_span = 5e9;  // s; beyond any clock that counts seconds, within 64-bit nanoseconds
    if (const auto count = cell_value(cell); count && std::abs(*count * columns.time->scale) < longest_span)
        return GpsTime(to_nanoseconds(Seconds(*count * columns.time->scale)));
    const Result<UtcTime> utc = parse_utc(cell);
    if (!utc) return fail(row.error(fmt::format("column {}: {}", columns.time->index + 1, utc.error().message)));
    dated = true;
    return to_gps_time(*utc, LeapSeconds::announced());
}

// An empty cell tells nothing.
Result<std::optional<int>> row_satellites(const TableRow& row, const FixColumns& columns) {
    if (!columns.used || row.cells[columns.used->index].empty()) return std::optional<int>();
    constexpr double most = 1000;
    const Result<double> count = cell_number(row, *columns.used, "number of satellites used");
    if (!count) return fail(count.error());
    if (!(*count >= 0 && *count <= most) || *count != std::floor(*count))
        return fail(row.error(fmt::format("column {}: the number of satellites used is {}; expected 0 to {}",
                                          columns.used->index + 1, *count, most)));
    return std::optional<int>(static_cast<int>(*count));
}

Result<FixSample> read_row(const TableRow& row, FixColumns& columns, bool& dated, TableCounts& counts) {
    if (row.cells.size() != columns.count)
        return fail(row.error(fmt::format("found {} cells, expected {}", row.cells.size(), columns.count)));
    FixSample sample;
    const auto time = row_time(row, columns, dated);
    if (!time) return fail(time.error());
    sample.time = *time;
    const Result<bool> has_fix = row_has_fix(row, columns, counts);
    if (!has_fix) return fail(has_fix.error());
    sample.has_fix = *has_fix;
    if (sample.has_fix) {
        const Result<Geodetic> position = estimate_at(row, columns);
        if (!position) return fail(position.error());
        sample.position = *position;
    }
    const auto used = row_satellites(row, columns);
    if (!used) return fail(used.error());
    sample.satellites_used = *used;
    if (columns.has_truth()) {
        const Result<Geodetic> truth =
            position_at(row, *columns.true_latitude, *columns.true_longitude, *columns.true_height);
        if (!truth) return fail(truth.error());
        sample.truth = *truth;
    }
    return sample;
}

Result<FixColumns> columns_of(const TableRow& first) {
    const bool numbers = std::all_of(first.cells.begin(), first.cells.end(),
                                     [](std::string_view cell) { return cell.empty() || cell_value(cell); });
    if (!numbers) {
        const auto columns = FixColumns::of(first.cells);
        if (!columns) return fail(first.error(columns.error()));
        return *columns;
    }
    if (first.cells.size() != 3)
        return fail(
            first.error(fmt::format("a row of {} number{} without a header line; expected the three columns "
                                    "latitude, longitude, height",
                                    first.cells.size(), first.cells.size() == 1 ? "" : "s")));
    return FixColumns::of_numbers();
}

std::size_t rows_back_in_time(const std::vector<FixSample>& samples) {
    std::size_t count = 0;
    for (std::size_t i = 1; i < samples.size(); ++i)
        if (samples[i].time && samples[i - 1].time && *samples[i].time < *samples[i - 1].time) ++count;
    return count;
}

// What was left out or taken for something, a sentence each.
void add_table_warnings(FixSeries& series, const FixColumns& columns, const TableCounts& counts) {
    const auto warn = [&](const std::string& what) {
        series.warnings.push_back(fmt::format("{}: {}", series.name, what));
    };
    if (counts.zero > 0)
        warn(fmt::format("{} rows at latitude 0, longitude 0 are not counted as fixes: what is not known is put there",
                         counts.zero));
    if (counts.partial > 0)
        warn(fmt::format("{} rows without one of latitude, longitude and height are not counted as fixes",
                         counts.partial));
    if (const std::size_t back = rows_back_in_time(series.samples); back > 0)
        warn(fmt::format("{} rows tell an earlier time than the row before them", back));
    for (const std::string& what : columns.hemispheres.notes({}))
        warn(what);
    if (!columns.above_sea.empty())
        warn(fmt::format("the heights of {} are above sea level, not above the ellipsoid", columns.above_sea));
    if (const std::string unread = fmt::format("{}", fmt::join(columns.unread_times, ", ")); !unread.empty())
        warn(
            fmt::format("no time is known: {:.80} is not read; expected a column such as time_utc, time, t_s or "
                        "timestamp_ms, or gps_week and tow_s",
                        unread));
}

}  // namespace

tl::expected<Geodetic, std::string> checked_position(double latitude_deg, double longitude_deg, double height_m) {
    if (!(std::abs(latitude_deg) <= 90))
        return tl::make_unexpected(
            fmt::format("latitude {} is out of range; expected -90 to 90 degrees", latitude_deg));
    if (!(longitude_deg >= -180 && longitude_deg <= 360))
        return tl::make_unexpected(
            fmt::format("longitude {} is out of range; expected -180 to 360 degrees", longitude_deg));
    if (!(std::abs(height_m) <= highest_height))
        return tl::make_unexpected(
            fmt::format("height {} m is out of range; expected at most {} m", height_m, highest_height));
    return Geodetic::degrees(latitude_deg, longitude_deg > 180 ? longitude_deg - 360 : longitude_deg, height_m);
}

Result<FixSeries> parse_fix_table(std::string_view text, const std::string& name) {
    FixSeries series;
    series.name = name;
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    std::optional<FixColumns> columns;
    TableCounts counts;
    char separator = ',';
    for (std::size_t line = 1; !text.empty(); ++line) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const bool unended = end == text.size();
        const std::string_view content = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        if (trimmed_cell(content).empty() || trimmed_cell(content).starts_with('#')) continue;
        if (!columns) separator = separator_in(trimmed_cell(content));
        const TableRow row{name, line, split_cells(separator == ' ' ? trimmed_cell(content) : content, separator)};
        if (!columns) {
            const Result<FixColumns> found = columns_of(row);
            if (!found) return fail(found.error());
            columns = *found;
            if (columns->named) continue;
        }
        if (unended && row.cells.size() < columns->count && !series.samples.empty()) {
            series.warnings.push_back(fmt::format("{}:{}: the last line is cut and was left out", name, line));
            break;
        }
        const Result<FixSample> sample = read_row(row, *columns, series.dated, counts);
        if (!sample) return fail(sample.error());
        series.samples.push_back(*sample);
    }
    if (const auto letters = columns ? columns->hemispheres.not_understood() : std::nullopt)
        return fail(ErrorCode::input, fmt::format("{}: {}", name, *letters));
    if (columns) add_table_warnings(series, *columns, counts);
    return series;
}

}  // namespace skyloop::inline study
