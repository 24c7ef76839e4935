#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <span>
#include <utility>

#include "base/core/files.hpp"
#include "base/core/table_text.hpp"
#include "base/time/utc_time.hpp"
#include "detail/run_tables.hpp"

namespace skyloop::inline study {

LineCells split_cells(std::string_view line, char separator) {
    LineCells cells;
    split_line(line, {&separator, 1}, separator == ' ', cells);
    return cells;
}

std::optional<double> cell_value(std::string_view cell) {
    if (cell.starts_with('+')) cell.remove_prefix(1);
    double value = 0;
    const auto [end, status] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (status != std::errc() || end != cell.data() + cell.size()) return std::nullopt;
    return value;
}

namespace {

using FixNames = std::span<const std::string_view>;

// What a quantity is called, alone, with its unit as the last word or with its unit in brackets.
constexpr std::array<std::string_view, 3> latitude_names{"latitude", "lat", "gps_lat"};
constexpr std::array<std::string_view, 5> longitude_names{"longitude", "lon", "lng", "long", "gps_lon"};
constexpr std::array<std::string_view, 10> height_names{
    "height", "ellipsoidal_height", "h_ell", "altitude", "alt", "hgt", "h", "alt_msl", "altitude_msl", "gps_alt"};
constexpr std::array<std::string_view, 6> date_names{"time_utc", "utc", "time", "timestamp", "datetime", "date_time"};
constexpr std::array<std::string_view, 5> count_names{"t", "time", "timestamp", "elapsed_time", "unix"};
// Words of names that tell a time, known or not.
constexpr std::array<std::string_view, 10> time_words{"t",    "time", "timestamp", "datetime", "date",
                                                      "unix", "utc",  "tow",       "itow",     "epoch"};
constexpr std::array<std::string_view, 4> used_names{"satellites_used", "num_sv", "numsv", "nsat"};

bool tells_time(std::string_view name) {
    while (!name.empty()) {
        const std::string_view word = name.substr(0, name.find('_'));
        if (std::find(time_words.begin(), time_words.end(), word) != time_words.end()) return true;
        name.remove_prefix(std::min(word.size() + 1, name.size()));
    }
    return false;
}

class FixHeader {
public:
    explicit FixHeader(const std::vector<std::string_view>& cells) : cells_(cells) {
        for (const std::string_view cell : cells)
            names_.push_back(bracketed_column_name(cell));
    }

    // By the whole name, whatever its brackets say.
    std::optional<FixColumn> called(FixNames names) const {
        for (const std::string_view name : names)
            for (std::size_t i = 0; i < names_.size(); ++i)
                if (names_[i].name == name) return FixColumn{i};
        return std::nullopt;
    }
    std::optional<FixColumn> called(std::string_view name) const { return called(FixNames(&name, 1)); }

    // With a unit behind the name before those with a unit in brackets or none.
    tl::expected<std::optional<FixColumn>, std::string> measured(FixNames names, Measured what) const {
        if (const auto suffixed = with_unit_behind(names, what)) return suffixed;
        auto column = called(names);
        if (!column || names_[column->index].unit.empty()) return column;
        const auto scale = unit_scale(names_[column->index].unit, what);
        if (!scale)
            return tl::make_unexpected(
                fmt::format("the unit of the column '{:.40}' is not known; expected one such as "
                            "{}",
                            cells_[column->index], what == Measured::angle ? "deg or rad" : "m or ft"));
        column->scale = *scale;
        return column;
    }

    // Dates, or a count of any unit.
    std::optional<FixColumn> time() const {
        if (auto dates = called(date_names)) {
            if (const auto scale = unit_scale(names_[dates->index].unit, Measured::time)) dates->scale = *scale;
            return dates;
        }
        return with_unit_behind(count_names, Measured::time);
    }

    // The columns whose names tell a time, as they are written.
    std::vector<std::string> times() const {
        std::vector<std::string> found;
        for (std::size_t i = 0; i < names_.size(); ++i)
            if (tells_time(names_[i].name)) found.emplace_back(cells_[i]);
        return found;
    }

    tl::unexpected<std::string> missing(const char* what, FixNames names) const {
        constexpr std::size_t longest_quote = 120;
        std::string found = fmt::format("{}", fmt::join(cells_, ","));
        if (found.size() > longest_quote) found = found.substr(0, longest_quote) + "...";
        return tl::make_unexpected(fmt::format("no column for the {}; found the header '{}', expected one of {}", what,
                                               found, fmt::join(names, ", ")));
    }
    [[nodiscard]] std::string_view cell(const FixColumn& column) const { return cells_[column.index]; }
    [[nodiscard]] const std::string& name(const FixColumn& column) const { return names_[column.index].name; }

private:
    std::optional<FixColumn> with_unit_behind(FixNames names, Measured what) const {
        for (const std::string_view name : names)
            for (std::size_t i = 0; i < names_.size(); ++i) {
                const ColumnName parts = column_name(names_[i].name);
                if (parts.name != name) continue;
                if (const auto scale = unit_scale(parts.unit, what)) return FixColumn{i, *scale};
            }
        return std::nullopt;
    }

    const std::vector<std::string_view>& cells_;
    std::vector<ColumnName> names_;
};

}  // namespace

FixColumns FixColumns::of_numbers() {
    FixColumns columns;
    columns.count = 3;
    columns.longitude.index = 1;
    columns.height.index = 2;
    return columns;
}

tl::expected<FixColumns, std::string> FixColumns::of(const std::vector<std::string_view>& cells) {
    const FixHeader header(cells);
    const auto latitude = header.measured(latitude_names, Measured::angle),
               longitude = header.measured(longitude_names, Measured::angle),
               height = header.measured(height_names, Measured::length);
    for (const auto* column : {&latitude, &longitude, &height})
        if (!*column) return tl::make_unexpected(column->error());
    if (!*latitude) return header.missing("latitude", latitude_names);
    if (!*longitude) return header.missing("longitude", longitude_names);
    if (!*height) return header.missing("height", height_names);
    FixColumns columns;
    columns.named = true;
    columns.count = cells.size();
    columns.latitude = **latitude;
    columns.longitude = **longitude;
    columns.height = **height;
    columns.hemispheres =
        HemisphereColumns({cells.begin(), cells.end()}, {columns.latitude.index, columns.longitude.index});
    if (header.name(**height).find("msl") != std::string::npos) columns.above_sea = header.cell(**height);
    columns.true_latitude = header.called("true_lat_deg");
    columns.true_longitude = header.called("true_lon_deg");
    columns.true_height = header.called("true_height_m");
    columns.fix_type = header.called("fix_type");
    columns.time = header.time();
    columns.week = header.called("gps_week");
    columns.tow = header.called("tow_s");
    if (!columns.time && !(columns.week && columns.tow)) columns.unread_times = header.times();
    columns.used = header.called(used_names);
    return columns;
}

namespace {

struct SatelliteColumns {
    std::size_t time = 0, elevation = 0, cn0 = 0, count = 0;
    std::optional<std::size_t> pseudorange{};

    // C/N0 stands in the table for all that arrives.
    [[nodiscard]] bool tracked(const LineCells& cells) const {
        return !cells[cn0].empty() && !(pseudorange && cells[*pseudorange].empty());
    }
};

std::optional<SatelliteColumns> satellite_columns(const LineCells& names) {
    SatelliteColumns columns{.count = names.size()};
    for (const auto& [name, column] :
         {std::pair("time_utc", &columns.time), std::pair("elevation_deg", &columns.elevation),
          std::pair("cn0_dbhz", &columns.cn0)}) {
        const auto found = std::find(names.begin(), names.end(), name);
        if (found == names.end()) return std::nullopt;
        *column = static_cast<std::size_t>(found - names.begin());
    }
    const auto pseudorange = std::find(names.begin(), names.end(), "pseudorange_m");
    if (pseudorange != names.end()) columns.pseudorange = static_cast<std::size_t>(pseudorange - names.begin());
    return columns;
}

// Each report goes to the last sample that is not younger than it.
void share_among_samples(const std::vector<DatedSignal>& signals, FixSeries& series) {
    std::vector<std::pair<GpsTime, std::size_t>> samples;
    for (std::size_t i = 0; i < series.samples.size(); ++i)
        if (series.samples[i].time) samples.emplace_back(*series.samples[i].time, i);
    if (samples.empty()) return;
    std::sort(samples.begin(), samples.end());
    for (const DatedSignal& signal : signals) {
        auto at = std::upper_bound(samples.begin(), samples.end(), signal.time,
                                   [](GpsTime time, const auto& sample) { return time < sample.first; });
        if (at != samples.begin()) --at;
        series.samples[at->second].signals.push_back(signal.report);
    }
}

}  // namespace

Result<std::vector<DatedSignal>> parse_satellites_table(std::string_view text, const std::string& name) {
    std::vector<DatedSignal> signals;
    std::optional<SatelliteColumns> columns;
    std::string_view time_cell;
    GpsTime time;
    const auto refusal = [&](std::size_t line, const std::string& what) {
        return fail(ErrorCode::input, fmt::format("{}:{}: {}", name, line, what));
    };
    for (std::size_t line = 1; !text.empty(); ++line) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const LineCells cells = split_cells(text.substr(0, end), ',');
        text.remove_prefix(std::min(end + 1, text.size()));
        if (!columns) {
            columns = satellite_columns(cells);
            if (!columns) return refusal(line, "no columns time_utc, elevation_deg and cn0_dbhz in the header");
            continue;
        }
        if (cells.size() == 1 && cells.front().empty()) continue;
        if (cells.size() != columns->count)
            return refusal(line, fmt::format("found {} cells, expected {}", cells.size(), columns->count));
        if (!columns->tracked(cells)) continue;
        const std::optional<double> elevation = cell_value(cells[columns->elevation]);
        const std::optional<double> cn0 = cell_value(cells[columns->cn0]);
        if (!elevation || !cn0 || !std::isfinite(*elevation) || !std::isfinite(*cn0))
            return refusal(line, "elevation_deg or cn0_dbhz is not a number");
        if (cells[columns->time] != time_cell || signals.empty()) {
            time_cell = cells[columns->time];
            const Result<UtcTime> utc = parse_utc(time_cell);
            if (!utc) return refusal(line, utc.error().message);
            time = to_gps_time(*utc, LeapSeconds::announced());
        }
        signals.push_back({time, {Angle::degrees(*elevation), DbHz(*cn0)}});
    }
    return signals;
}

void add_satellites_beside(const std::filesystem::path& fixes, FixSeries& series) {
    const std::string name = fixes.filename().string();
    if (name != "fixes.csv" && name != "fixes.csv.gz") return;
    for (const char* beside : {"satellites.csv", "satellites.csv.gz"}) {
        const std::filesystem::path path = fixes.parent_path() / beside;
        std::error_code unreadable;
        if (!std::filesystem::exists(path, unreadable)) continue;
        const Result<std::string> text = read_text_file(path);
        const Result<std::vector<DatedSignal>> signals =
            text ? parse_satellites_table(*text, path.string())
                 : Result<std::vector<DatedSignal>>(tl::make_unexpected(text.error()));
        if (!signals)
            series.warnings.push_back(signals.error().message + "; C/N0 by elevation is left out");
        else if (!series.dated)
            series.warnings.push_back(
                fmt::format("{}: its rows have no dates to find those of {} by; C/N0 by elevation is left out",
                            fixes.string(), path.string()));
        else
            share_among_samples(*signals, series);
        return;
    }
}

}  // namespace skyloop::inline study
