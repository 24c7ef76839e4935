#include "world/gnss/ionosphere_maps.hpp"

#include <algorithm>
#include <cmath>

namespace skyloop {
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

}  // namespace skyloop
