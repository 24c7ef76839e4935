#include "world/gnss/sbas_grid.hpp"

#include <algorithm>
#include <cmath>

namespace skyloop::inline world {
namespace {

constexpr int sbas_band_width = 40, sbas_half_turn = 180;

// Every second meridian goes on in steps of 10° beyond latitude 55.
void add_meridian(std::vector<SbasGridPoint>& points, int longitude) {
    const bool far = longitude % 10 == 0;
    // Of each 90° one has a point at 85° north, and another one, 40° on, at 85° south.
    if ((longitude - 40) % 90 == 0) points.push_back({-85, longitude});
    if (far) points.insert(points.end(), {{-75, longitude}, {-65, longitude}});
    for (int latitude = -55; latitude <= 55; latitude += 5)
        points.push_back({latitude, longitude});
    if (far) points.insert(points.end(), {{65, longitude}, {75, longitude}});
    if (longitude % 90 == 0) points.push_back({85, longitude});
}

void add_parallel(std::vector<SbasGridPoint>& points, SbasGridPoint first, int step) {
    for (int longitude = first.longitude; longitude < sbas_half_turn; longitude += step)
        points.push_back({first.latitude, longitude});
}

std::vector<SbasGridPoint> points_of_band(int band) {
    std::vector<SbasGridPoint> points;
    if (band < 9) {
        const int west = band * sbas_band_width - sbas_half_turn;
        for (int longitude = west; longitude < west + sbas_band_width; longitude += 5)
            add_meridian(points, longitude);
        return points;
    }
    const int side = band == 9 ? 1 : -1;
    add_parallel(points, {side * 60, -sbas_half_turn}, 5);
    for (const int latitude : {65, 70, 75})
        add_parallel(points, {side * latitude, -sbas_half_turn}, 10);
    add_parallel(points, {side * 85, band == 9 ? -sbas_half_turn : -170}, 30);
    return points;
}

}  // namespace

const std::vector<SbasGridPoint>& sbas_band(int band) {
    static const auto bands = [] {
        std::array<std::vector<SbasGridPoint>, sbas_band_count> all;
        for (int i = 0; i < sbas_band_count; ++i)
            all[static_cast<std::size_t>(i)] = points_of_band(i);
        return all;
    }();
    return bands.at(static_cast<std::size_t>(band));
}

SbasMaskPlace sbas_mask_place(const SbasGridPoint& point) {
    const int band = (point.longitude + sbas_half_turn) / sbas_band_width;
    const auto& points = sbas_band(band);
    const auto found = std::ranges::find(points, point);
    return {band, found == points.end() ? 0 : static_cast<int>(found - points.begin()) + 1};
}

std::array<SbasGridPoint, 4> SbasCell::corners() const {
    const int north_edge = corner.latitude + size;
    const int east_edge = corner.longitude + size >= sbas_half_turn ? -sbas_half_turn : corner.longitude + size;
    return {SbasGridPoint{north_edge, east_edge}, {north_edge, corner.longitude}, corner, {corner.latitude, east_edge}};
}

std::optional<SbasCell> sbas_cell(const PiercePoint& where) {
    constexpr double fine = 55, last = 75;
    const double latitude = where.latitude.deg();
    if (std::abs(latitude) > last) return std::nullopt;
    double longitude = std::remainder(where.longitude.deg(), 360.0);
    if (longitude >= sbas_half_turn) longitude = -sbas_half_turn;
    SbasCell cell;
    cell.size = std::abs(latitude) <= fine ? 5 : 10;
    const double offset = cell.size == 5 ? 0 : 5;  // the parallels 55, 65 and 75
    const double size = cell.size;
    // The last parallel of each kind of square belongs to the one south of it.
    double south = std::floor((latitude - offset) / size) * size + offset;
    if (south + size > (cell.size == 5 ? fine : last)) south -= size;
    const double west = std::floor(longitude / size) * size;
    cell.corner = {static_cast<int>(south), static_cast<int>(west)};
    cell.east = (longitude - west) / size;
    cell.north = (latitude - south) / size;
    return cell;
}

}  // namespace skyloop::inline world
