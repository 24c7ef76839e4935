#include "track_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>

namespace skyloop {
namespace {

struct KnownColumn {
    std::string_view name;
    TrackQuantity quantity;
    double scale;
};

constexpr double foot = 0.3048, knot = 1852.0 / 3600, mile_per_hour = 0.44704, degrees_of = 180 / std::numbers::pi;

using Q = TrackQuantity;
// FEEDS.md 1.2, and the columns of fixes.csv, which are ours.
constexpr std::array known_columns{KnownColumn{"t_s", Q::since_start, 1},
                                   KnownColumn{"t_ms", Q::since_start, 1e-3},
                                   KnownColumn{"t_us", Q::since_start, 1e-6},
                                   KnownColumn{"t_ns", Q::since_start, 1e-9},
                                   KnownColumn{"unix_s", Q::posix, 1},
                                   KnownColumn{"unix_ms", Q::posix, 1e-3},
                                   KnownColumn{"unix_us", Q::posix, 1e-6},
                                   KnownColumn{"unix_ns", Q::posix, 1e-9},
                                   KnownColumn{"utc", Q::utc, 1},
                                   KnownColumn{"time_utc", Q::utc, 1},
                                   KnownColumn{"gps_week", Q::gps_week, 1},
                                   KnownColumn{"tow_s", Q::tow, 1},
                                   KnownColumn{"lat_deg", Q::latitude, 1},
                                   KnownColumn{"lon_deg", Q::longitude, 1},
                                   KnownColumn{"lat_rad", Q::latitude, degrees_of},
                                   KnownColumn{"lon_rad", Q::longitude, degrees_of},
                                   KnownColumn{"lat_e7", Q::latitude, 1e-7},
                                   KnownColumn{"lon_e7", Q::longitude, 1e-7},
                                   KnownColumn{"h_ell_m", Q::height, 1},
                                   KnownColumn{"height_m", Q::height, 1},
                                   KnownColumn{"h_ell_ft", Q::height, foot},
                                   KnownColumn{"h_ell_cm", Q::height, 1e-2},
                                   KnownColumn{"h_ell_mm", Q::height, 1e-3},
                                   KnownColumn{"alt_msl_m", Q::altitude, 1},
                                   KnownColumn{"alt_msl_ft", Q::altitude, foot},
                                   KnownColumn{"alt_msl_cm", Q::altitude, 1e-2},
                                   KnownColumn{"alt_msl_mm", Q::altitude, 1e-3},
                                   KnownColumn{"x_ecef_m", Q::x, 1},
                                   KnownColumn{"y_ecef_m", Q::y, 1},
                                   KnownColumn{"z_ecef_m", Q::z, 1},
                                   KnownColumn{"vn_mps", Q::north, 1},
                                   KnownColumn{"ve_mps", Q::east, 1},
                                   KnownColumn{"vd_mps", Q::down, 1},
                                   KnownColumn{"vu_mps", Q::up, 1},
                                   KnownColumn{"vel_north_mps", Q::north, 1},
                                   KnownColumn{"vel_east_mps", Q::east, 1},
                                   KnownColumn{"vel_down_mps", Q::down, 1},
                                   KnownColumn{"speed_mps", Q::speed, 1},
                                   KnownColumn{"speed_kmh", Q::speed, 1 / 3.6},
                                   KnownColumn{"speed_kn", Q::speed, knot},
                                   KnownColumn{"speed_mph", Q::speed, mile_per_hour},
                                   KnownColumn{"speed_fps", Q::speed, foot},
                                   KnownColumn{"course_deg", Q::course, 1},
                                   KnownColumn{"climb_mps", Q::climb, 1},
                                   KnownColumn{"roll_deg", Q::roll, 1},
                                   KnownColumn{"pitch_deg", Q::pitch, 1},
                                   KnownColumn{"yaw_deg", Q::yaw, 1},
                                   KnownColumn{"roll_rad", Q::roll, degrees_of},
                                   KnownColumn{"pitch_rad", Q::pitch, degrees_of},
                                   KnownColumn{"yaw_rad", Q::yaw, degrees_of},
                                   KnownColumn{"fix", Q::fix, 1}};

}  // namespace

Result<TrackColumns> TrackColumns::of(std::span<const std::string_view> header) {
    TrackColumns columns;
    for (std::size_t i = 0; i < header.size(); ++i) {
        const std::string_view name = header[i];
        const auto* const known = std::find_if(known_columns.begin(), known_columns.end(),
                                               [&](const KnownColumn& column) { return column.name == name; });
        if (known == known_columns.end()) {
            if (!name.empty()) columns.unused_.emplace_back(name);
            continue;
        }
        auto& column = columns.columns_[static_cast<std::size_t>(known->quantity)];
        if (column)
            return fail(ErrorCode::input,
                        fmt::format("columns {} and {} say the same; expected one of them", column->name, name));
        column = TrackColumn{i, known->scale, std::string(name)};
    }
    if (const auto right = columns.check(); !right) return fail(right.error());
    return columns;
}

Result<void> TrackColumns::check() const {
    const bool gps = has(Q::gps_week) && has(Q::tow);
    if (!has(Q::since_start) && !has(Q::posix) && !has(Q::utc) && !gps)
        return fail(
            ErrorCode::input,
            "no column says the time; expected t_s, t_ms, t_us, t_ns, unix_s, unix_ms, unix_us, unix_ns, utc, or "
            "gps_week and tow_s in the first line");
    const bool cartesian = has(Q::x) && has(Q::y) && has(Q::z);
    const bool geodetic = has(Q::latitude) && has(Q::longitude);
    if (!cartesian && !geodetic)
        return fail(
            ErrorCode::input,
            "no columns say the place; expected lat_deg and lon_deg, lat_rad and lon_rad, lat_e7 and lon_e7, or "
            "x_ecef_m, y_ecef_m and z_ecef_m in the first line");
    if (geodetic && !cartesian && !has(Q::height) && !has(Q::altitude))
        return fail(ErrorCode::input,
                    "no column says the height; expected h_ell_m (above the ellipsoid) or alt_msl_m (above sea level)");
    return {};
}

}  // namespace skyloop
