/// A map of what a receiver finds in an area, in colours.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "study/analysis/coverage_map.hpp"
#include "world/scene/urban_scene.hpp"

namespace skyloop {

/// What is shown.
enum class CoverageQuantity : std::uint8_t { line_of_sight, satellites, hdop, fix, error };

inline constexpr std::array coverage_quantity_names{"los", "satellites", "hdop", "fix", "error"};

/// The value of a cell; nothing where it has none.
std::optional<double> coverage_value(const CoverageCell& cell, CoverageQuantity quantity);

inline constexpr double coverage_plot_width = 820;
inline constexpr double coverage_plot_height = 900;

/// The picture as an SVG document of at most a few megabytes: cells by colour, buildings grey above them, a bar that
/// tells the colours' values. Light is good: more satellites, less dilution, less error. Of more than 500 by 500 cells
/// some are left out evenly. @param scene may be absent
std::string coverage_plot_svg(const CoverageMap& map, CoverageQuantity quantity, const UrbanScene* scene);

}  // namespace skyloop
