#include "detail/track_cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/core/number_in.hpp"
#include "base/core/table_line.hpp"
#include "base/core/written_place.hpp"
#include "base/geo/geodetic.hpp"
#include "base/time/utc_time.hpp"
#include "motion/trajectory/track_doubts.hpp"

namespace skyloop {

bool says_nothing(std::string_view plain) { return plain.empty() || plain.front() == '#' || plain.front() == '%'; }

std::string_view first_row_line(std::string_view text) {
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        if (!says_nothing(trimmed_cell(text.substr(0, end)))) return text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return {};
}

Result<GpsTime> time_of_utc_cell(std::string_view text) {
    constexpr std::size_t date_and_time = 19;  // characters, at least
    const std::size_t sign = text.find_last_of("+-");
    const bool zoned = sign != std::string_view::npos && sign >= date_and_time;
    const auto zone = zoned ? zone_minutes(text.substr(sign)) : std::nullopt;
    const auto local = parse_utc(zone ? text.substr(0, sign) : text);
    if (!local) return fail(local.error());
    return to_gps_time(utc_of_local(*local, zone.value_or(0)), LeapSeconds::announced());
}

bool is_absent(std::string_view text) { return text.empty() || text == "nan" || text == "NaN" || text == "NAN"; }

std::optional<std::string> mistake_of_place(const Position<Ecef>& place) {
    const double radius = place.vector().norm();
    if (radius > 6.3e6 && radius < 1.7e7) return std::nullopt;
    return fmt::format("the place lies {:.0f} m from the Earth's centre; expected 6300000 to 17000000", radius);
}

std::optional<double> number_of_cell(std::string_view text, const TrackColumn& column, TrackQuantity quantity) {
    const std::string_view plain = text.substr(text.starts_with('+') ? 1 : 0);
    if (const auto value = number_in<double>(plain)) return *value * column.scale;
    const bool latitude = quantity == TrackQuantity::latitude;
    if (column.scale != 1 || !(latitude || quantity == TrackQuantity::longitude)) return std::nullopt;
    return written_degrees(text, latitude ? Coordinate::latitude : Coordinate::longitude);
}

double climb_by_heights(std::span<const TrackRow> rows, std::size_t row) {
    constexpr Nanoseconds near_rows = std::chrono::seconds(30);
    const auto seconds = [&](std::size_t a, std::size_t b) { return to_seconds(rows[b].time - rows[a].time).value(); };
    const auto is_near = [&](std::size_t a, std::size_t b) {
        const Nanoseconds span = rows[b].time - rows[a].time;
        return !rows[b].jump && span.count() > 0 && span <= near_rows;
    };
    const auto slope = [&](std::size_t a, std::size_t b) {
        const auto height = [&](std::size_t i) { return to_geodetic(rows[i].position).height.above_ellipsoid.value(); };
        return (height(b) - height(a)) / seconds(a, b);
    };
    const bool before = row > 0 && is_near(row - 1, row), after = row + 1 < rows.size() && is_near(row, row + 1);
    if (before && after) {
        const double h1 = seconds(row - 1, row), h2 = seconds(row, row + 1);
        return (h2 * slope(row - 1, row) + h1 * slope(row, row + 1)) / (h1 + h2);
    }
    return before ? slope(row - 1, row) : after ? slope(row, row + 1) : 0;
}

}  // namespace skyloop
