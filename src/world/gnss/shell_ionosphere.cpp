#include "world/gnss/shell_ionosphere.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace skyloop::inline world {
namespace {

double shell_ratio(const ThinShell& shell, Metres antenna_height) {
    return (shell.earth_radius + antenna_height).value() / (shell.earth_radius + shell.height).value();
}

double obliquity(double sine_at_shell) { return 1 / std::sqrt(1 - sine_at_shell * sine_at_shell); }

}  // namespace

Angle pierce_angle(const ThinShell& shell, Angle elevation, Metres antenna_height) {
    const double sine_at_shell = shell_ratio(shell, antenna_height) * std::cos(elevation.rad());
    return Angle::radians(std::numbers::pi / 2 - elevation.rad() - std::asin(std::min(sine_at_shell, 1.0)));
}

double gradient_arm(Angle elevation, Metres antenna_height) {
    constexpr Angle full_size = Angle::degrees(9);
    return pierce_angle(ThinShell(), elevation, antenna_height).rad() / full_size.rad();
}

PiercePoint pierce_point(const ThinShell& shell, const Geodetic& place, const SkyDirection& direction) {
    const double azimuth = direction.azimuth.rad();
    const double psi = pierce_angle(shell, direction.elevation, place.height.above_ellipsoid).rad();
    const double sin_latitude = std::sin(place.latitude.rad()), cos_latitude = std::cos(place.latitude.rad());
    const double north = std::sin(psi) * std::cos(azimuth);
    const double sine = sin_latitude * std::cos(psi) + cos_latitude * north;
    // By atan2, so that rays over a pole come down on the other side.
    const double east = std::sin(psi) * std::sin(azimuth);
    const double along = cos_latitude * std::cos(psi) - sin_latitude * north;
    const double longitude = place.longitude.rad() + std::atan2(east, along);
    return {Angle::radians(std::atan2(sine, std::hypot(east, along))),
            Angle::radians(std::remainder(longitude, 2 * std::numbers::pi))};
}

PiercePoint published_pierce_point(const ThinShell& shell, const Geodetic& place, const SkyDirection& direction) {
    PiercePoint point = pierce_point(shell, place, direction);
    const double full = 2 * std::numbers::pi, half = std::numbers::pi;
    const double turn = std::remainder((point.longitude - place.longitude).rad(), full);
    if (std::abs(turn) > half / 2)
        point.longitude =
            Angle::radians(std::remainder(place.longitude.rad() + std::copysign(half, turn) - turn, full));
    return point;
}

double single_layer_mapping(const ThinShell& shell, Angle elevation, Metres antenna_height) {
    return obliquity(shell_ratio(shell, antenna_height) * std::cos(elevation.rad()));
}

double modified_single_layer_mapping(const ThinShell& shell, Angle elevation) {
    return obliquity(shell_ratio(shell, Metres(0)) * std::sin(0.9782 * (std::numbers::pi / 2 - elevation.rad())));
}

Metres ionosphere_group_delay(Tecu slant_content, Hertz carrier) {
    return Metres(40.3e16 * slant_content.value() / (carrier.value() * carrier.value()));
}

namespace {

// A place between two lines of a grid.
struct GridCell {
    std::size_t below = 0, above = 0;
    double fraction = 0;
};

constexpr double grid_rounding = 1e-9;  // of a step: what degrees lose on their way to radians and back

std::optional<GridCell> latitude_cell(const GridAxis& axis, Angle latitude) {
    const double last = static_cast<double>(axis.count - 1);
    double row = (latitude - axis.first).rad() / axis.step.rad();
    if (row < -1 - grid_rounding || row > last + 1 + grid_rounding) return std::nullopt;
    row = std::clamp(row, 0.0, last);
    const auto below = static_cast<std::size_t>(row);
    return GridCell{below, std::min(below + 1, axis.count - 1), row - static_cast<double>(below)};
}

std::optional<GridCell> longitude_cell(const GridAxis& axis, Angle longitude) {
    const double last = static_cast<double>(axis.count - 1);
    const double turn = 360 / std::abs(axis.step.deg());
    double column = std::fmod((longitude - axis.first).rad() / axis.step.rad(), turn);
    if (column < 0) column += turn;
    if (turn - column < grid_rounding) column = 0;
    const auto below = static_cast<std::size_t>(column);
    const double fraction = column - static_cast<double>(below);
    if (column <= last) return GridCell{below, std::min(below + 1, axis.count - 1), fraction};
    if (column <= last + grid_rounding) return GridCell{axis.count - 1, axis.count - 1, 0};
    // Grids of the whole globe may leave out the meridian at which they close.
    if (last + 1 < turn - grid_rounding) return std::nullopt;
    return GridCell{axis.count - 1, 0, fraction};
}

}  // namespace

std::optional<Tecu> map_content(const IonosphereMaps& maps, const IonosphereMap& map, const PiercePoint& where) {
    const auto row = latitude_cell(maps.latitude, where.latitude);
    const auto column = longitude_cell(maps.longitude, where.longitude);
    if (!row || !column) return std::nullopt;
    double sum = 0;
    const auto add = [&](std::size_t i, std::size_t j, double weight) {
        // A missing value does not matter where it has no weight.
        if (weight > 0) sum += weight * map.content_tecu[i * maps.longitude.count + j];
    };
    add(row->below, column->below, (1 - row->fraction) * (1 - column->fraction));
    add(row->below, column->above, (1 - row->fraction) * column->fraction);
    add(row->above, column->below, row->fraction * (1 - column->fraction));
    add(row->above, column->above, row->fraction * column->fraction);
    if (std::isnan(sum)) return std::nullopt;
    return Tecu(sum);
}

std::optional<Tecu> turned_content(const IonosphereMaps& maps, const IonosphereMap& map, const PiercePoint& where,
                                   GpsTime time) {
    // The pierce point moves with the Sun to the instant of the map.
    const double seconds = difference(time, map.time).value();
    return map_content(maps, map,
                       {where.latitude, where.longitude + Angle::degrees(360 * seconds / double(seconds_per_day))});
}

std::optional<Tecu> vertical_content(const IonosphereMaps& maps, const PiercePoint& where, GpsTime time) {
    const auto& all = maps.maps;
    if (all.empty() || time < all.front().time || time > all.back().time) return std::nullopt;
    const auto after = std::upper_bound(all.begin(), all.end(), time,
                                        [](GpsTime t, const IonosphereMap& map) { return t < map.time; });
    const IonosphereMap& before = *(after - 1);
    const std::optional<Tecu> first = turned_content(maps, before, where, time);
    if (!first || after == all.end() || time == before.time) return first;
    const std::optional<Tecu> second = turned_content(maps, *after, where, time);
    if (!second) return std::nullopt;
    const double fraction = difference(time, before.time).value() / difference(after->time, before.time).value();
    return *first * (1 - fraction) + *second * fraction;
}

std::optional<Tecu> held_content(const IonosphereMaps& maps, const PiercePoint& where, GpsTime time) {
    if (maps.maps.empty()) return std::nullopt;
    const IonosphereMap& last = maps.maps.back();
    return time > last.time ? turned_content(maps, last, where, time) : vertical_content(maps, where, time);
}

namespace {

constexpr double two_pi = 2 * std::numbers::pi;

// Daily variation, F1.
double ntcm_daily(double latitude, double longitude, const IonosphereTime& when) {
    const double local_time = when.hours + longitude / two_pi * 24;
    const double diurnal = two_pi * (local_time - 14) / 24;
    const double semidiurnal = two_pi * local_time / 12;
    const double terdiurnal = two_pi * local_time / 8;
    const double declination =
        Angle::degrees(23.44 * std::sin(Angle::degrees(0.9856 * (when.day_of_year - 80.7)).rad())).rad();
    const double solar = std::cos(latitude - declination);
    const double c3 = solar + 0.4;
    const double c2 = solar - 2 / std::numbers::pi * latitude * std::sin(declination);
    return c3 + c2 * (0.92519 * std::cos(diurnal) + 0.16951 * std::cos(semidiurnal) + 0.00443 * std::sin(semidiurnal) +
                      0.06626 * std::cos(terdiurnal) + 0.00899 * std::sin(terdiurnal));
}

// Annual and semiannual variation, F2.
double ntcm_seasonal(double day_of_year) {
    return 1 + 0.21289 * std::cos(two_pi * (day_of_year - 18) / 365.25) -
           0.15414 * std::cos(2 * two_pi * (day_of_year - 6) / 365.25);
}

// Latitude in the field of a dipole whose northern pole lies at 79.74° N, 71.78° W.
double ntcm_magnetic_latitude(double latitude, double longitude) {
    const double pole = Angle::degrees(79.74).rad();
    return std::asin(std::sin(latitude) * std::sin(pole) +
                     std::cos(latitude) * std::cos(pole) * std::cos(longitude + Angle::degrees(71.78).rad()));
}

// The two crests of the equatorial anomaly, F4.
double ntcm_crests(double magnetic_latitude_deg) {
    const double north = (magnetic_latitude_deg - 16) / 12, south = (magnetic_latitude_deg + 10) / 13;
    return 1 + 1.14023 * std::exp(-north * north / 2) + 1.20556 * std::exp(-south * south / 2);
}

// The number that stands for the Sun's activity, Azpar, solar flux units (MODELS.md A.5); where none is given as in
// NeQuick-G.
double ntcm_ionisation(const EffectiveIonisation& b) {
    if (!b.given()) return default_ionisation_level;
    return std::sqrt(b.a0 * b.a0 + 1633.33 * b.a1 * b.a1 + 4802000 * b.a2 * b.a2 + 3266.67 * b.a0 * b.a2);
}

Tecu ntcm_vertical_content(const EffectiveIonisation& broadcast, const PiercePoint& where, const IonosphereTime& when) {
    const double latitude = where.latitude.rad(), longitude = where.longitude.rad();
    const double magnetic = ntcm_magnetic_latitude(latitude, longitude);
    const double f3 = 1 - 0.38439 * std::cos(magnetic);
    const double f5 = 1.41808 + 0.13985 * ntcm_ionisation(broadcast);
    return Tecu(ntcm_daily(latitude, longitude, when) * ntcm_seasonal(when.day_of_year) * f3 *
                ntcm_crests(Angle::radians(magnetic).deg()) * f5);
}

}  // namespace

IonosphereTime IonosphereTime::of(const UtcTime& utc) {
    return {std::floor(skyloop::day_of_year(utc)), utc.seconds_of_day() / 3600};
}

Tecu ntcm_g_content(const EffectiveIonisation& broadcast, const PiercePoint& pierce, Angle elevation,
                    const IonosphereTime& when) {
    return ntcm_vertical_content(broadcast, pierce, when) * modified_single_layer_mapping(ThinShell(), elevation);
}

}  // namespace skyloop::inline world
