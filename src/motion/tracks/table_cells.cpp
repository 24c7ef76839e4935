#include "detail/table_cells.hpp"
#include "base/core/letter_case.hpp"
#include "base/core/number_in.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace skyloop {

bool TableCells::next() {
    while (lines_.next()) {
        const std::string_view plain = trimmed_cell(lines_.line());
        if (plain.empty() || comments_.find(plain.front()) != std::string::npos) continue;
        split_table_line(lines_.line(), separator_, cells_);
        return true;
    }
    return false;
}

void TableCells::take_names() {
    names_.clear();
    for (const std::string_view cell : cells_)
        names_.push_back(lower_case(cell));
}

Result<void> TableCells::check_width() const {
    if (const auto mistake = width_mistake(cells_, names_.size())) return refusal(*mistake);
    return {};
}

std::optional<std::size_t> TableCells::column(std::string_view name) const {
    const auto at = std::find(names_.begin(), names_.end(), lower_case(name));
    return at == names_.end() ? std::nullopt : std::optional(static_cast<std::size_t>(at - names_.begin()));
}

std::string_view TableCells::cell(std::optional<std::size_t> column) const {
    return column && *column < cells_.size() ? cells_[*column] : std::string_view();
}

Result<std::optional<double>> TableCells::number(std::optional<std::size_t> column) const {
    const std::string_view text = cell(column);
    if (text.empty() || lower_case(text) == "nan") return std::nullopt;
    const auto value = text_number(text);
    if (value) return value;
    const std::string what = *column < names_.size() ? names_[*column] : fmt::format("cell {}", *column + 1);
    return refusal(fmt::format("{:.40} is '{:.40}'; expected a number with a decimal point", what, text));
}

Result<std::optional<double>> TableCells::coordinate(std::optional<std::size_t> column, Coordinate which) const {
    auto plain = number(column);
    if (plain) return plain;
    const auto written = written_degrees(cell(column), which);
    return written ? written : std::move(plain);
}

Result<std::optional<std::array<double, 2>>> TableCells::place(std::array<std::string_view, 2> names) {
    const std::array columns{column(names[0]), column(names[1])};
    const auto latitude = coordinate(columns[0], Coordinate::latitude),
               longitude = coordinate(columns[1], Coordinate::longitude);
    if (!latitude) return fail(latitude.error());
    if (!longitude) return fail(longitude.error());
    if (!*latitude || !*longitude) return std::nullopt;
    if (!places_) {
        places_ = {*columns[0], *columns[1]};
        hemispheres_ = HemisphereColumns(names_, *places_);
    }
    const auto place = hemispheres_.place(cells_, {**latitude, **longitude}, line());
    if (!place) return refusal(place.error());
    return *place;
}

Result<std::vector<double>> TableCells::numbers(std::size_t first, std::size_t count) const {
    std::vector<double> values;
    for (std::size_t i = first; i < first + count; ++i) {
        const auto value = number(i);
        if (!value) return fail(value.error());
        if (!*value)
            return refusal(fmt::format("cell {} is '{}'; expected {} numbers in a row", i + 1, cell(i), first + count));
        values.push_back(**value);
    }
    return values;
}

tl::unexpected<Error> TableCells::refusal(const std::string& what) const {
    return fail(ErrorCode::input, fmt::format("{}:{}: {}", name_, line(), one_line_of(what)));
}

std::optional<Nanoseconds> posix_since_1980(std::string_view seconds) {
    const std::size_t point = std::min(seconds.find('.'), seconds.size());
    const auto whole = number_in<std::int64_t>(seconds.substr(0, point));
    constexpr std::int64_t latest = 7258118400;  // 2200-01-01
    if (!whole || *whole < gps_epoch_posix_s || *whole >= latest) return std::nullopt;
    const auto fraction = point < seconds.size() ? text_number(seconds.substr(point)) : std::optional(0.0);
    if (!fraction || *fraction < 0 || *fraction >= 1) return std::nullopt;
    const Nanoseconds since_1970 = std::chrono::seconds(*whole) + Nanoseconds(std::llround(*fraction * 1e9));
    return from_posix(since_1970, LeapSeconds::announced()).time_since_epoch();
}

std::optional<Nanoseconds> week_since_1980(double week, double tow_s) {
    constexpr double latest_week = 11400;  // of the year 2198
    if (!(week >= 0 && week < latest_week && week == std::floor(week) && tow_s >= 0 && tow_s <= seconds_per_week))
        return std::nullopt;
    return to_gps_time(static_cast<std::int64_t>(week), tow_s).time_since_epoch();
}

bool is_table_dialect(const TrackFile& file) {
    constexpr std::size_t looked_at = 65536;
    const std::string_view head = file.text.substr(0, looked_at);
    return is_named_dialect(head) || is_shaped_dialect(file);
}

Result<Track> read_table_dialect(const TrackFile& file) {
    constexpr std::size_t looked_at = 65536;
    const std::string_view head = file.text.substr(0, looked_at);
    if (is_named_dialect(head)) return read_named_dialect(file);
    return read_shaped_dialect(file);
}

}  // namespace skyloop
