#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numbers>

#include "base/core/number_text.hpp"
#include "base/core/std_additions.hpp"
#include "base/core/table_text.hpp"
#include "base/core/words.hpp"
#include "base/core/written_place.hpp"
#include "base/geo/geodetic.hpp"
#include "base/time/utc_time.hpp"
#include "detail/track_table.hpp"
#include "motion/trajectory/track.hpp"

namespace skyloop::inline motion {
namespace {

struct KnownColumn {
    std::string_view name;
    TrackQuantity quantity;
    double scale;
};

constexpr double foot = 0.3048, knot = 1852.0 / 3600, mile_per_hour = 0.44704, degrees_of = 180 / std::numbers::pi;

using Q = TrackQuantity;
// FEEDS.md 1.2, and the columns of fixes.csv, which are ours.
constexpr std::array known_columns{
    KnownColumn{"t_s", Q::since_start, 1}, KnownColumn{"t_ms", Q::since_start, 1e-3},
    KnownColumn{"t_us", Q::since_start, 1e-6}, KnownColumn{"t_ns", Q::since_start, 1e-9},
    KnownColumn{"unix_s", Q::posix, 1}, KnownColumn{"unix_ms", Q::posix, 1e-3}, KnownColumn{"unix_us", Q::posix, 1e-6},
    KnownColumn{"unix_ns", Q::posix, 1e-9}, KnownColumn{"utc", Q::utc, 1}, KnownColumn{"time_utc", Q::utc, 1},
    KnownColumn{"gps_week", Q::gps_week, 1}, KnownColumn{"tow_s", Q::tow, 1}, KnownColumn{"lat_deg", Q::latitude, 1},
    KnownColumn{"lon_deg", Q::longitude, 1}, KnownColumn{"lat_rad", Q::latitude, degrees_of},
    KnownColumn{"lon_rad", Q::longitude, degrees_of}, KnownColumn{"lat_e7", Q::latitude, 1e-7},
    KnownColumn{"lon_e7", Q::longitude, 1e-7}, KnownColumn{"h_ell_m", Q::height, 1},
    KnownColumn{"height_m", Q::height, 1}, KnownColumn{"h_ell_ft", Q::height, foot},
    KnownColumn{"h_ell_cm", Q::height, 1e-2}, KnownColumn{"h_ell_mm", Q::height, 1e-3},
    KnownColumn{"alt_msl_m", Q::altitude, 1}, KnownColumn{"alt_msl_ft", Q::altitude, foot},
    KnownColumn{"alt_msl_cm", Q::altitude, 1e-2}, KnownColumn{"alt_msl_mm", Q::altitude, 1e-3},
    KnownColumn{"x_ecef_m", Q::x, 1}, KnownColumn{"y_ecef_m", Q::y, 1}, KnownColumn{"z_ecef_m", Q::z, 1},
    KnownColumn{"vn_mps", Q::north, 1}, KnownColumn{"ve_mps", Q::east, 1}, KnownColumn{"vd_mps", Q::down, 1},
    KnownColumn{"vu_mps", Q::up, 1}, KnownColumn{"vel_north_mps", Q::north, 1}, KnownColumn{"vel_east_mps", Q::east, 1},
    KnownColumn{"vel_down_mps", Q::down, 1}, KnownColumn{"speed_mps", Q::speed, 1},
    KnownColumn{"speed_kmh", Q::speed, 1 / 3.6}, KnownColumn{"speed_kn", Q::speed, knot},
    KnownColumn{"speed_mph", Q::speed, mile_per_hour}, KnownColumn{"speed_fps", Q::speed, foot},
    KnownColumn{"course_deg", Q::course, 1}, KnownColumn{"climb_mps", Q::climb, 1}, KnownColumn{"roll_deg", Q::roll, 1},
    KnownColumn{"pitch_deg", Q::pitch, 1}, KnownColumn{"yaw_deg", Q::yaw, 1},
    KnownColumn{"roll_rad", Q::roll, degrees_of}, KnownColumn{"pitch_rad", Q::pitch, degrees_of},
    KnownColumn{"yaw_rad", Q::yaw, degrees_of}, KnownColumn{"qw", Q::qw, 1}, KnownColumn{"qx", Q::qx, 1},
    KnownColumn{"qy", Q::qy, 1}, KnownColumn{"qz", Q::qz, 1}, KnownColumn{"n_m", Q::local_north, 1},
    KnownColumn{"e_m", Q::local_east, 1}, KnownColumn{"u_m", Q::local_up, 1}, KnownColumn{"d_m", Q::local_down, 1},
    // Of Betaflight's recorder, as blackbox_decode writes them.
    KnownColumn{"gps_coord[0]", Q::latitude, 1}, KnownColumn{"gps_coord[1]", Q::longitude, 1},
    KnownColumn{"fix", Q::fix, 1}, KnownColumn{"reset", Q::reset, 1}};

// In letters of either case; names of one word, such as "fix", stand for something else when they begin with a capital.
bool is_called(const KnownColumn& column, std::string_view name) {
    return column.name == name || (name.find('_') != std::string_view::npos && column.name == lower_case(name));
}

// What other programs call a quantity, and what its unit measures. Of several for one quantity the earlier one counts.
struct OtherName {
    std::string_view name;
    TrackQuantity quantity;
    Measured measures;
};
constexpr std::array other_names{OtherName{"datetime", Q::utc, Measured::calendar},
                                 OtherName{"timestamp", Q::utc, Measured::calendar},
                                 OtherName{"time", Q::utc, Measured::calendar},
                                 OtherName{"time", Q::since_start, Measured::time},
                                 OtherName{"elapsed_time", Q::since_start, Measured::time},
                                 OtherName{"unix_time", Q::posix, Measured::time},
                                 OtherName{"latitude", Q::latitude, Measured::angle},
                                 OtherName{"lat", Q::latitude, Measured::angle},
                                 OtherName{"longitude", Q::longitude, Measured::angle},
                                 OtherName{"lon", Q::longitude, Measured::angle},
                                 OtherName{"lng", Q::longitude, Measured::angle},
                                 OtherName{"height_above_ellipsoid", Q::height, Measured::length},
                                 OtherName{"ellipsoidal_height", Q::height, Measured::length},
                                 OtherName{"altitude_above_sealevel", Q::altitude, Measured::length},
                                 OtherName{"altitude_msl", Q::altitude, Measured::length},
                                 OtherName{"altitude", Q::altitude, Measured::length},
                                 OtherName{"alt", Q::altitude, Measured::length},
                                 OtherName{"elevation", Q::altitude, Measured::length},
                                 OtherName{"ele", Q::altitude, Measured::length},
                                 OtherName{"gps_altitude", Q::altitude, Measured::length},
                                 OtherName{"ground_speed", Q::speed, Measured::speed},
                                 OtherName{"speed", Q::speed, Measured::speed},
                                 OtherName{"gps_speed", Q::speed, Measured::speed},
                                 OtherName{"course", Q::course, Measured::angle},
                                 OtherName{"bearing", Q::course, Measured::angle},
                                 OtherName{"gps_ground_course", Q::course, Measured::angle},
                                 OtherName{"course_over_ground", Q::course, Measured::angle},
                                 OtherName{"climb", Q::climb, Measured::speed},
                                 OtherName{"vertical_speed", Q::climb, Measured::speed},
                                 OtherName{"roll", Q::roll, Measured::angle},
                                 OtherName{"pitch", Q::pitch, Measured::angle},
                                 OtherName{"yaw", Q::yaw, Measured::angle}};

// Places are in degrees where they do not tell a unit.
ColumnName name_and_unit(std::string_view text) {
    ColumnName parts = column_name(text);
    constexpr std::array<std::string_view, 5> places{"latitude", "longitude", "lat", "lon", "lng"};
    if (parts.unit.empty() && std::find(places.begin(), places.end(), parts.name) != places.end()) parts.unit = "deg";
    return parts;
}

std::size_t rank_of_other_name(std::string_view text) {
    const std::string name = name_and_unit(text).name;
    return static_cast<std::size_t>(std::find_if(other_names.begin(), other_names.end(),
                                                 [&](const OtherName& other) { return other.name == name; }) -
                                    other_names.begin());
}

// Lengths, speeds and courses without a unit are in metres, m/s and degrees, as most write them.
bool may_tell_no_unit(const OtherName& other) {
    return other.measures == Measured::length || other.measures == Measured::speed || other.quantity == Q::course;
}

// A count of a clock, whose unit shows in its size: since 1970, or small, since the start.
struct ClockCount {
    TrackQuantity quantity;
    double scale;
    std::string_view told;
};
ClockCount clock_count(double count) {
    constexpr double year_1979_s = 3e8;
    constexpr std::array counts{
        ClockCount{Q::posix, 1e-9, "nanoseconds since 1970"}, ClockCount{Q::posix, 1e-6, "microseconds since 1970"},
        ClockCount{Q::posix, 1e-3, "milliseconds since 1970"}, ClockCount{Q::posix, 1, "seconds since 1970"}};
    for (const ClockCount& one : counts)
        if (count * one.scale >= year_1979_s) return one;
    return {Q::since_start, 1, "seconds from the start"};
}

}  // namespace

// A time without a unit: what it is shows in the first row.
bool TrackColumns::take_bare_time(std::string_view name, std::size_t index, std::string_view cell) {
    constexpr std::array<std::string_view, 4> names{"time", "timestamp", "datetime", "date_time"};
    const ColumnName parts = bracketed_column_name(name);
    if (!parts.unit.empty() || std::find(names.begin(), names.end(), parts.name) == names.end()) return false;
    const auto take = [&](TrackQuantity quantity, double scale, std::string_view told) {
        columns_[static_cast<std::size_t>(quantity)] = TrackColumn{index, scale, std::string(name)};
        understood_.push_back(fmt::format("{} tells no unit, and is taken as {}", name, told));
        return true;
    };
    if (!has(Q::utc) && time_of_utc_cell(cell)) return take(Q::utc, 1, "a date and a time of day, UTC without a zone");
    const auto count = number_in<double>(cell);
    if (!count || has_time()) return false;
    const ClockCount clock = clock_count(*count);
    return take(clock.quantity, clock.scale, clock.told);
}

// By a name and a unit that others use. The format's own names go before these, whatever their order.
bool TrackColumns::take_other_name(std::string_view name, std::size_t index) {
    const ColumnName parts = name_and_unit(name), whole = bracketed_column_name(name);
    for (const OtherName& other : other_names) {
        auto scale = other.name == parts.name ? unit_scale(parts.unit, other.measures) : std::nullopt;
        const bool bare = !scale && whole.unit.empty() && other.name == whole.name && may_tell_no_unit(other);
        if (bare) scale = 1;
        if (!scale) continue;
        auto& column = columns_[static_cast<std::size_t>(other.quantity)];
        if (column) return false;
        column = TrackColumn{index, *scale, std::string(name)};
        if (other.quantity == Q::altitude) understood_.push_back(std::string(name) + " is taken above sea level");
        if (bare)
            understood_.push_back(fmt::format("{} tells no unit, and is taken in {}", name,
                                              other.measures == Measured::length  ? "metres"
                                              : other.measures == Measured::speed ? "m/s"
                                                                                  : "degrees"));
        return true;
    }
    return false;
}

Result<TrackColumns> TrackColumns::of(std::span<const std::string_view> header,
                                      std::span<const std::string_view> first_row) {
    TrackColumns columns;
    std::vector<std::size_t> others;
    for (std::size_t i = 0; i < header.size(); ++i) {
        const std::string_view name = header[i];
        const auto* const known = std::find_if(known_columns.begin(), known_columns.end(),
                                               [&](const KnownColumn& column) { return is_called(column, name); });
        if (known == known_columns.end()) {
            others.push_back(i);
            continue;
        }
        auto& column = columns.columns_[static_cast<std::size_t>(known->quantity)];
        if (column)
            return fail(ErrorCode::input,
                        fmt::format("columns {} and {} say the same; expected one of them", column->name, name));
        column = TrackColumn{i, known->scale, std::string(name)};
    }
    // Better names for a quantity stand earlier in the table of other names.
    std::stable_sort(others.begin(), others.end(), [&](std::size_t a, std::size_t b) {
        return rank_of_other_name(header[a]) < rank_of_other_name(header[b]);
    });
    for (const std::size_t i : others) {
        const std::string_view cell = i < first_row.size() ? first_row[i] : std::string_view();
        if (!columns.take_other_name(header[i], i) && !columns.take_bare_time(header[i], i, cell) && !header[i].empty())
            columns.unused_.emplace_back(header[i]);
    }
    if (const auto right = columns.check(); !right) return fail(right.error());
    return columns;
}

namespace {

// A name whose unit is not known: its table is no route.
bool looks_like_a_time(std::string_view name) {
    const std::string lower = lower_case(name);
    constexpr std::array<std::string_view, 4> words{"time", "date", "utc", "epoch"};
    return std::any_of(words.begin(), words.end(),
                       [&](std::string_view word) { return lower.find(word) != std::string::npos; });
}

}  // namespace

Result<void> TrackColumns::check() const {
    const bool cartesian = has(Q::x) && has(Q::y) && has(Q::z);
    const bool geodetic = has(Q::latitude) && has(Q::longitude);
    const bool places = cartesian || geodetic || has_local();
    const auto named_time = std::find_if(unused_.begin(), unused_.end(), looks_like_a_time);
    const bool names_time = named_time != unused_.end();
    if (!has_time() && (!places || names_time))
        return fail(
            ErrorCode::input,
            (names_time ? fmt::format("no column says the time, for that of {:.40} is in no form or unit that is known",
                                      *named_time)
                        : "no column says the time") +
                "; expected t_s, t_ms, t_us, t_ns, unix_s, unix_ms, unix_us, unix_ns, utc, or "
                "gps_week and tow_s in the first line");
    if (!places)
        return fail(ErrorCode::input,
                    "no columns say the place; expected lat_deg and lon_deg, lat_rad and lon_rad, lat_e7 and lon_e7, "
                    "x_ecef_m, y_ecef_m and z_ecef_m, or n_m, e_m and d_m or u_m in the first line");
    if (geodetic && !cartesian && !has_local() && !has(Q::height) && !has(Q::altitude))
        return fail(ErrorCode::input,
                    "no column says the height; expected h_ell_m (above the ellipsoid) or alt_msl_m (above sea level)");
    return {};
}

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

void TrackDates::add(Nanoseconds counted, Nanoseconds dated) {
    offsets_.push_back(dated - counted);
    whole_seconds_ &= dated % std::chrono::seconds(1) == Nanoseconds(0);
}

std::optional<Nanoseconds> TrackDates::of_count_zero() const {
    constexpr Nanoseconds together = std::chrono::seconds(2), cut = std::chrono::seconds(1);
    constexpr std::size_t of_ten = 10, fewest = 9;
    if (empty()) return std::nullopt;
    std::vector<Nanoseconds> sorted = offsets_;
    const Nanoseconds middle = middle_of(sorted);
    std::size_t agreeing = 0;
    Nanoseconds latest = middle;
    for (const Nanoseconds offset : offsets_) {
        if (std::chrono::abs(offset - middle) <= together) ++agreeing;
        if (std::chrono::abs(offset - middle) <= cut) latest = std::max(latest, offset);
    }
    if (agreeing * of_ten < offsets_.size() * fewest) return std::nullopt;
    return whole_seconds_ ? latest : middle;
}

void TrackDates::date(Track& track, const std::string& count, const std::string& date) const {
    const auto zero = of_count_zero();
    if (!zero)
        return track.notes.push_back(fmt::format("times are those of {} alone: {} {}", count, date,
                                                 empty() ? "tells none" : "does not run with it"));
    track.notes.push_back(fmt::format("times count by {}; what GPS time that is follows from {}", count, date));
    track.origin = GpsTime{};
    for (TrackRow& row : track.points)
        row.time += *zero;
}

}  // namespace skyloop::inline motion
