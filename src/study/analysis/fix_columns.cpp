#include "detail/fix_columns.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <span>

#include "base/core/column_name.hpp"

namespace skyloop {
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

}  // namespace skyloop
