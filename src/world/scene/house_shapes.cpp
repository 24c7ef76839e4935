#include "detail/house_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace skyloop::inline world {
namespace {

constexpr int triangles_of_cell = 18;

int cells_along(double length, double pitch) { return std::max(1, static_cast<int>(length / pitch)); }

Eigen::Vector3d raised(const Eigen::Vector2d& place, double height) { return {place.x(), place.y(), height}; }

/// A wall as a grid of cells. Points of its ends are the house's corners to the last bit, so that walls join.
struct WindowWall {
    Eigen::Vector2d from, to;
    double base, top;
    int columns, floors;

    [[nodiscard]] Eigen::Vector2d along(double column) const {
        if (column >= columns) return to;
        return from + (to - from) * (column / columns);
    }
    [[nodiscard]] double height(double floor) const {
        return floor >= floors ? top : base + (top - base) * (floor / floors);
    }
    /// A point of the wall, set back by `recess`: the house lies to the left of from → to.
    [[nodiscard]] Eigen::Vector3d point(double column, double floor, double recess = 0) const {
        const Eigen::Vector2d u = (to - from).normalized();
        return raised(along(column) + recess * Eigen::Vector2d(-u.y(), u.x()), height(floor));
    }
};

// A frame of four facets around the window, its four reveals and the pane.
void add_cell(CityModel& city, const WindowWall& wall, std::array<int, 2> at, const House& house,
              const WindowSettings& windows) {
    const double c = at[0], f = at[1];
    const std::array outer{wall.point(c, f), wall.point(c + 1, f), wall.point(c + 1, f + 1), wall.point(c, f + 1)};
    constexpr double left = 0.25, right = 0.75, sill = 0.3, lintel = 0.8;
    std::array<Eigen::Vector3d, 4> inner, pane;
    for (std::size_t k = 0; k < 4; ++k) {
        const double column = c + (k == 0 || k == 3 ? left : right), floor = f + (k < 2 ? sill : lintel);
        inner[k] = wall.point(column, floor);
        pane[k] = wall.point(column, floor, windows.recess);
    }
    for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t next = (k + 1) % 4;
        city.add_quad({outer[k], outer[next], inner[next], inner[k]}, SurfaceKind::wall, house.walls);
        // Sill and lintel lie flat.
        const SurfaceKind reveal = k % 2 == 0 ? SurfaceKind::roof : SurfaceKind::wall;
        city.add_quad({inner[k], inner[next], pane[next], pane[k]}, reveal, house.walls);
    }
    city.add_quad(pane, SurfaceKind::wall, windows.pane);
}

// A lid around its middle: it shares every edge with the cells below.
void add_fan(CityModel& city, const std::vector<Eigen::Vector3d>& rim, const House& house) {
    const Eigen::Vector3d middle = raised(house.middle, rim.front().z());
    for (std::size_t k = 0; k < rim.size(); ++k)
        city.add_triangle({middle, rim[k], rim[(k + 1) % rim.size()]}, SurfaceKind::roof, house.roof);
}

void add_lid(CityModel& city, const House& house, double height) {
    const auto c = corners(house);
    city.add_quad({raised(c[0], height), raised(c[1], height), raised(c[2], height), raised(c[3], height)},
                  SurfaceKind::roof, house.roof);
}

}  // namespace

std::array<Eigen::Vector2d, 4> corners(const House& house) {
    const double c = std::cos(house.yaw), s = std::sin(house.yaw);
    std::array<Eigen::Vector2d, 4> result;
    for (std::size_t k = 0; k < 4; ++k) {
        const double x = (k == 0 || k == 3 ? -0.5 : 0.5) * house.width, y = (k < 2 ? -0.5 : 0.5) * house.depth;
        result[k] = house.middle + Eigen::Vector2d(c * x - s * y, s * x + c * y);
    }
    return result;
}

void add_house(CityModel& city, const House& house) {
    const auto c = corners(house);
    for (std::size_t k = 0; k < 4; ++k) {
        const auto &a = c[k], &b = c[(k + 1) % 4];
        city.add_quad({raised(a, house.base), raised(b, house.base), raised(b, house.height), raised(a, house.height)},
                      SurfaceKind::wall, house.walls);
    }
    add_lid(city, house, house.height);
    if (house.base > 0) add_lid(city, house, house.base);
}

void add_windowed_house(CityModel& city, const House& house, const WindowSettings& windows) {
    const auto c = corners(house);
    std::vector<Eigen::Vector3d> rim;
    for (std::size_t k = 0; k < 4; ++k) {
        const WindowWall wall{c[k],
                              c[(k + 1) % 4],
                              house.base,
                              house.height,
                              cells_along(k % 2 == 0 ? house.width : house.depth, windows.pitch),
                              cells_along(house.height - house.base, windows.pitch)};
        for (int column = 0; column < wall.columns; ++column) {
            for (int floor = 0; floor < wall.floors; ++floor)
                add_cell(city, wall, {column, floor}, house, windows);
            rim.push_back(wall.point(column, wall.floors));
        }
    }
    add_fan(city, rim, house);
}

std::size_t windowed_house_triangles(const House& house, const WindowSettings& windows) {
    const int columns = 2 * (cells_along(house.width, windows.pitch) + cells_along(house.depth, windows.pitch));
    return static_cast<std::size_t>(columns) *
           static_cast<std::size_t>(triangles_of_cell * cells_along(house.height - house.base, windows.pitch) + 1);
}

void add_ground(CityModel& city, double half_width, std::uint8_t material) {
    const double e = half_width;
    city.add_quad({{{-e, -e, 0}, {e, -e, 0}, {e, e, 0}, {-e, e, 0}}}, SurfaceKind::ground, material);
}

}  // namespace skyloop::inline world
