#include "fix_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "skyloop/base/spelling.hpp"
#include "skyloop/flow/fix.hpp"
#include "skyloop/time/utc_time.hpp"
#include "table_cells.hpp"

namespace skyloop {
namespace {

// No aircraft, no satellite that carries a GNSS receiver is higher, m.
constexpr double highest_height = 1e8;

using Names = std::span<const std::string_view>;
constexpr std::array<std::string_view, 5> latitude_names{"lat_deg", "latitude_deg", "latitude", "lat", "gps_lat"};
constexpr std::array<std::string_view, 7> longitude_names{"lon_deg", "longitude_deg", "longitude", "lon",
                                                          "lng",     "long",          "gps_lon"};
constexpr std::array<std::string_view, 10> height_names{
    "height_m", "ellipsoidal_height_m", "altitude_m", "alt_m", "height", "altitude", "alt", "hgt", "h", "gps_alt"};
constexpr std::array<std::string_view, 4> used_names{"satellites_used", "num_sv", "numsv", "nsat"};
constexpr std::array<std::string_view, 6> time_names{"time_utc", "utc", "time", "timestamp", "datetime", "date_time"};

// Where the cells of a row stand; npos: no such column.
struct Columns {
    static constexpr std::size_t none = static_cast<std::size_t>(-1);
    bool named = false;  ///< the first line is a header, not a sample
    std::size_t count = 0;
    std::size_t latitude = none, longitude = none, height = none;
    std::size_t true_latitude = none, true_longitude = none, true_height = none;
    std::size_t fix_type = none, time = none, week = none, tow = none, used = none;

    [[nodiscard]] bool has_truth() const {
        return true_latitude != none && true_longitude != none && true_height != none;
    }
};

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

char separator_of(std::string_view line) {
    for (const char c : {',', ';', '\t'})
        if (line.find(c) != std::string_view::npos) return c;
    return ' ';
}

// "Latitude (deg)" and "lat_deg" are the same column to a reader.
std::string normal_name(std::string_view cell) {
    std::string name;
    for (const char c : cell.substr(0, cell.find_first_of("([")))
        name += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : (c == ' ' || c == '-' ? '_' : c);
    while (name.ends_with('_'))
        name.pop_back();
    return name;
}

std::size_t column_of(const std::vector<std::string>& header, Names names) {
    for (const std::string_view name : names) {
        const auto at = std::find(header.begin(), header.end(), name);
        if (at != header.end()) return static_cast<std::size_t>(at - header.begin());
    }
    return Columns::none;
}

std::size_t column_of(const std::vector<std::string>& header, std::string_view name) {
    return column_of(header, Names(&name, 1));
}

Result<Columns> read_header(const TableRow& row) {
    std::vector<std::string> header;
    for (const std::string_view cell : row.cells)
        header.push_back(normal_name(cell));
    Columns columns;
    columns.named = true;
    columns.count = header.size();
    columns.latitude = column_of(header, latitude_names);
    columns.longitude = column_of(header, longitude_names);
    columns.height = column_of(header, height_names);
    columns.true_latitude = column_of(header, "true_lat_deg");
    columns.true_longitude = column_of(header, "true_lon_deg");
    columns.true_height = column_of(header, "true_height_m");
    columns.fix_type = column_of(header, "fix_type");
    columns.time = column_of(header, time_names);
    columns.week = column_of(header, "gps_week");
    columns.tow = column_of(header, "tow_s");
    columns.used = column_of(header, used_names);
    const auto missing = [&](const char* what, Names names) {
        constexpr std::size_t longest_quote = 120;
        std::string found = fmt::format("{}", fmt::join(row.cells, ","));
        if (found.size() > longest_quote) found = found.substr(0, longest_quote) + "...";
        return fail(row.error(fmt::format("no column for the {}; found the header '{}', expected one of {}", what,
                                          found, fmt::join(names, ", "))));
    };
    if (columns.latitude == Columns::none) return missing("latitude", latitude_names);
    if (columns.longitude == Columns::none) return missing("longitude", longitude_names);
    if (columns.height == Columns::none) return missing("height", height_names);
    return columns;
}

Result<double> cell_number(const TableRow& row, std::size_t column, std::string_view what) {
    const std::optional<double> value = cell_value(row.cells[column]);
    if (!value || !std::isfinite(*value))
        return fail(row.error(fmt::format("column {}: the {} is '{}'; expected a number", column + 1, what,
                                          quotable(row.cells[column]))));
    return *value;
}

Result<Geodetic> position_at(const TableRow& row, std::size_t latitude, std::size_t longitude, std::size_t height) {
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

// Whether a row is a fix: fix_type decides where there is one, else three empty cells mean none.
Result<bool> row_has_fix(const TableRow& row, const Columns& columns) {
    if (columns.fix_type == Columns::none)
        return !(row.cells[columns.latitude].empty() && row.cells[columns.longitude].empty() &&
                 row.cells[columns.height].empty());
    constexpr std::array types{FixType::none,  FixType::dead_reckoning, FixType::fix_2d,    FixType::fix_3d,
                               FixType::dgnss, FixType::rtk_float,      FixType::rtk_fixed, FixType::time_only};
    const std::string_view cell = row.cells[columns.fix_type];
    std::vector<std::string_view> names;
    for (const FixType type : types) {
        if (cell == fix_type_name(type)) return type != FixType::none && type != FixType::time_only;
        names.push_back(fix_type_name(type));
    }
    return fail(row.error(fmt::format("fix_type is '{}'; expected one of {}{}", quotable(cell), fmt::join(names, ", "),
                                      did_you_mean(cell, names))));
}

// ISO 8601 dates a row; a bare number of seconds only tells rows apart.
Result<std::optional<GpsTime>> row_time(const TableRow& row, const Columns& columns, bool& dated) {
    if (columns.week != Columns::none && columns.tow != Columns::none) {
        const Result<double> week = cell_number(row, columns.week, "GPS week");
        if (!week) return fail(week.error());
        const Result<double> tow = cell_number(row, columns.tow, "time of week");
        if (!tow) return fail(tow.error());
        if (*week < 0 || *week > 9999 || *tow < 0 || *tow > static_cast<double>(seconds_per_week))
            return fail(row.error(fmt::format("GPS week {} and time of week {} s are out of range", *week, *tow)));
        dated = true;
        return to_gps_time(static_cast<std::int64_t>(*week), *tow);
    }
    if (columns.time == Columns::none || row.cells[columns.time].empty()) return std::optional<GpsTime>();
    const std::string_view cell = row.cells[columns.time];
    constexpr double longest_span = 5e9;  // s; beyond any clock that counts seconds, within 64-bit nanoseconds
    if (const auto seconds = cell_value(cell); seconds && std::abs(*seconds) < longest_span)
        return GpsTime(to_nanoseconds(Seconds(*seconds)));
    const Result<UtcTime> utc = parse_utc(cell);
    if (!utc) return fail(row.error(fmt::format("column {}: {}", columns.time + 1, utc.error().message)));
    dated = true;
    return to_gps_time(*utc, LeapSeconds::announced());
}

// An empty cell tells nothing.
Result<std::optional<int>> row_satellites(const TableRow& row, const Columns& columns) {
    if (columns.used == Columns::none || row.cells[columns.used].empty()) return std::optional<int>();
    constexpr double most = 1000;
    const Result<double> count = cell_number(row, columns.used, "number of satellites used");
    if (!count) return fail(count.error());
    if (!(*count >= 0 && *count <= most) || *count != std::floor(*count))
        return fail(row.error(fmt::format("column {}: the number of satellites used is {}; expected 0 to {}",
                                          columns.used + 1, *count, most)));
    return std::optional<int>(static_cast<int>(*count));
}

Result<FixSample> read_row(const TableRow& row, const Columns& columns, bool& dated) {
    if (row.cells.size() != columns.count)
        return fail(row.error(fmt::format("found {} cells, expected {}", row.cells.size(), columns.count)));
    FixSample sample;
    const auto time = row_time(row, columns, dated);
    if (!time) return fail(time.error());
    sample.time = *time;
    const Result<bool> has_fix = row_has_fix(row, columns);
    if (!has_fix) return fail(has_fix.error());
    sample.has_fix = *has_fix;
    if (sample.has_fix) {
        const Result<Geodetic> position = position_at(row, columns.latitude, columns.longitude, columns.height);
        if (!position) return fail(position.error());
        sample.position = *position;
    }
    const auto used = row_satellites(row, columns);
    if (!used) return fail(used.error());
    sample.satellites_used = *used;
    if (columns.has_truth()) {
        const Result<Geodetic> truth =
            position_at(row, columns.true_latitude, columns.true_longitude, columns.true_height);
        if (!truth) return fail(truth.error());
        sample.truth = *truth;
    }
    return sample;
}

Result<Columns> columns_of(const TableRow& first) {
    const bool numbers = std::all_of(first.cells.begin(), first.cells.end(),
                                     [](std::string_view cell) { return cell.empty() || cell_value(cell); });
    if (!numbers) return read_header(first);
    if (first.cells.size() != 3)
        return fail(
            first.error(fmt::format("a row of {} number{} without a header line; expected the three columns "
                                    "latitude, longitude, height",
                                    first.cells.size(), first.cells.size() == 1 ? "" : "s")));
    Columns columns;
    columns.count = 3;
    columns.latitude = 0;
    columns.longitude = 1;
    columns.height = 2;
    return columns;
}

}  // namespace

tl::expected<Geodetic, std::string> checked_position(double latitude_deg, double longitude_deg, double height_m) {
    if (!(std::abs(latitude_deg) <= 90))
        return tl::make_unexpected(
            fmt::format("latitude {} is out of range; expected -90 to 90 degrees", latitude_deg));
    if (!(longitude_deg >= -180 && longitude_deg <= 360))
        return tl::make_unexpected(
            fmt::format("longitude {} is out of range; expected -180 to 180 degrees", longitude_deg));
    if (!(std::abs(height_m) <= highest_height))
        return tl::make_unexpected(
            fmt::format("height {} m is out of range; expected at most {} m", height_m, highest_height));
    return Geodetic::degrees(latitude_deg, longitude_deg > 180 ? longitude_deg - 360 : longitude_deg, height_m);
}

Result<FixSeries> parse_fix_table(std::string_view text, const std::string& name) {
    FixSeries series;
    series.name = name;
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    std::optional<Columns> columns;
    char separator = ',';
    for (std::size_t line = 1; !text.empty(); ++line) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view content = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        if (without_blanks(content).empty() || without_blanks(content).starts_with('#')) continue;
        if (!columns) separator = separator_of(without_blanks(content));
        const TableRow row{name, line, split_cells(separator == ' ' ? without_blanks(content) : content, separator)};
        if (!columns) {
            const Result<Columns> found = columns_of(row);
            if (!found) return fail(found.error());
            columns = *found;
            if (columns->named) continue;
        }
        const Result<FixSample> sample = read_row(row, *columns, series.dated);
        if (!sample) return fail(sample.error());
        series.samples.push_back(*sample);
    }
    return series;
}

}  // namespace skyloop
