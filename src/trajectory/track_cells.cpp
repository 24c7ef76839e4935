#include "track_cells.hpp"

#include <algorithm>
#include <chrono>
#include <string>

#include "skyloop/base/cell_end.hpp"
#include "skyloop/geo/geodetic.hpp"
#include "skyloop/time/utc_time.hpp"

namespace skyloop {
namespace {

// East of UTC: "+01:00", "-0330" or "+02".
std::optional<int> minutes_of_zone(std::string_view text) {
    const int sign = text.front() == '-' ? -1 : 1;
    std::string digits;
    for (const char letter : text.substr(1)) {
        if (letter == ':' && digits.size() == 2) continue;
        if (letter < '0' || letter > '9') return std::nullopt;
        digits += letter;
    }
    if (digits.size() != 2 && digits.size() != 4) return std::nullopt;
    const auto two = [&](std::size_t at) {
        return at < digits.size() ? (digits[at] - '0') * 10 + digits[at + 1] - '0' : 0;
    };
    if (two(0) > 14 || two(2) > 59) return std::nullopt;
    return sign * (two(0) * 60 + two(2));
}

}  // namespace

std::string_view trimmed_track_cell(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\r\"");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r\"") - first + 1);
}

char track_separator(std::string_view header) {
    for (const char candidate : {',', ';', '\t'})
        if (header.find(candidate) != std::string_view::npos) return candidate;
    return ' ';
}

void split_track_cells(std::string_view line, char separator, TrackCells& cells) {
    cells.clear();
    constexpr std::string_view blanks = " \t";
    const bool blank = separator == ' ';
    const std::string_view separators = blank ? blanks : std::string_view(&separator, 1);
    if (blank) {
        line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
        line = line.substr(0, line.find_last_not_of(" \t\r") + 1);
    }
    for (;;) {
        const std::size_t end = end_of_cell(line, separators);
        cells.push_back(trimmed_track_cell(line.substr(0, end)));
        if (end == std::string_view::npos) return;
        line.remove_prefix(end + 1);
        if (blank) line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
    }
}

Result<GpsTime> time_of_utc_cell(std::string_view text) {
    using namespace std::chrono;
    constexpr std::size_t date_and_time = 19;  // characters, at least
    const std::size_t sign = text.find_last_of("+-");
    const bool zoned = sign != std::string_view::npos && sign >= date_and_time;
    const auto zone = zoned ? minutes_of_zone(text.substr(sign)) : std::nullopt;
    const auto local = parse_utc(zone ? text.substr(0, sign) : text);
    if (!local) return fail(local.error());
    if (!zone) return to_gps_time(*local, LeapSeconds::announced());
    // By POSIX time, which knows no leap seconds between here and there.
    const sys_days day = year_month_day(year(local->year), month(local->month), std::chrono::day(local->day));
    const Nanoseconds of_day = hours(local->hour) + minutes(local->minute) + seconds(local->second) +
                               nanoseconds(local->nanosecond) - minutes(*zone);
    return from_posix(nanoseconds(day.time_since_epoch()) + of_day, LeapSeconds::announced());
}

double climb_by_heights(const std::vector<TrackRow>& rows, std::size_t row) {
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
