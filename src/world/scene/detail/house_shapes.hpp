/// Houses of made-up cities.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>

#include "world/scene/city_model.hpp"

namespace skyloop::inline world {

/// An upright box on the ground.
struct House {
    Eigen::Vector2d middle;            ///< east, north, m
    double yaw = 0;                    ///< of its width from east, anticlockwise, rad
    double width = 0, depth = 0;       ///< m
    double height = 0;                 ///< m
    std::uint8_t walls = 0, roof = 0;  ///< materials
    double base = 0;                   ///< m; above the ground there is a floor too
};

/// The four corners on the map, anticlockwise.
std::array<Eigen::Vector2d, 4> corners(const House& house);

/// Four walls and a flat roof: 10 triangles; 12 with the floor of one that does not stand on the ground.
void add_house(CityModel& city, const House& house);

/// What makes a window wall: each cell of a wall holds one pane, set back.
struct WindowSettings {
    double pitch = 3;       ///< width and height of a cell, about, m
    double recess = 0.2;    ///< m
    std::uint8_t pane = 0;  ///< material
};

/// The same house with a window in every cell of its walls: facets meet edge to edge.
void add_windowed_house(CityModel& city, const House& house, const WindowSettings& windows);
/// How many triangles that adds.
std::size_t windowed_house_triangles(const House& house, const WindowSettings& windows);

/// One square of ground.
void add_ground(CityModel& city, double half_width, std::uint8_t material = 0);

}  // namespace skyloop::inline world
