/// A city from above, with an antenna in it and the ways of signals.
/// A map of what a receiver finds in an area, in colours.
#pragma once

#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "study/analysis/coverage_map.hpp"
#include "study/analysis/scene_sky.hpp"
#include "world/gnss/satellite.hpp"
#include "world/scene/urban_scene.hpp"

namespace skyloop::inline study {

/// One satellite's signal as a line from the antenna over its points of reflection and on towards the satellite.
struct ScenePlotRay {
    SatelliteId id;
    Reception reception = Reception::line_of_sight;
    std::vector<Eigen::Vector3d> points;  ///< of reflection, from the antenna outwards, scene frame
    Eigen::Vector3d departure;            ///< unit, towards the satellite after the last of them
};

/// Everything that the picture says. Lengths are metres in the scene's frame.
struct ScenePlot {
    std::string title;
    std::string subtitle;                     ///< empty: how large it is and what it holds
    std::optional<Eigen::AlignedBox2d> area;  ///< east, north; nothing: all of it
    std::optional<Eigen::Vector3d> observer;  ///< the antenna
    std::vector<ScenePlotRay> rays;
};

/// What the picture shows of one satellite: its direct ray, its first reflected path, or that it is blocked.
/// @param satellite in the scene's frame
ScenePlotRay scene_plot_ray(const SceneReception& reception, const SceneSatellite& satellite,
                            const Eigen::Vector3d& antenna);

/// A square of `radius` metres around a place.
Eigen::AlignedBox2d scene_plot_area(const Eigen::Vector3d& middle, double radius);

inline constexpr double scene_plot_width = 820;
inline constexpr double scene_plot_height = 900;

/// The picture as an SVG document of at most a few megabytes, however large the city.
std::string scene_plot_svg(const UrbanScene& scene, const ScenePlot& plot);

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

}  // namespace skyloop::inline study
