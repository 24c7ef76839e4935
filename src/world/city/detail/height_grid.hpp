/// Heights on a grid, whatever its format.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>
#include <vector>

#include "place_on_earth.hpp"
#include "world/city/city_file.hpp"

namespace skyloop::inline world {

/// The middles of its cells lie at equal steps in the coordinates of its system.
struct HeightGrid {
    std::size_t columns = 0, rows = 0;
    Eigen::Vector2d first, next_column, next_row;  ///< of the first cell, and from one to the next
    std::vector<double> heights;                   ///< m, row by row; NaN where there is none
    std::size_t dropped = 0;                       ///< heights that are no numbers
    std::optional<ReferenceSystem> system;

    /// A height in units of the settings as metres, NaN for none; counts what is no number.
    [[nodiscard]] double usable(double height, bool absent, const CityFileSettings& settings);
};

/// Refuses what would be more triangles than the settings allow.
Result<void> check_grid_size(const HeightGrid& grid, std::string_view name, const CityFileSettings& settings);

/// The grid as ground.
Result<CityFile> city_of_grid(HeightGrid grid, std::string_view name, const CityFileSettings& settings);

}  // namespace skyloop::inline world
