/// A run through a city: the track over the buildings, and what arrived while it was driven.
#pragma once

#include <memory>
#include <string>

#include "study/analysis/city_run.hpp"
#include "world/scene/urban_scene.hpp"

namespace skyloop::inline study {

inline constexpr double city_run_plot_width = 960;
inline constexpr double city_run_plot_height = 1120;

/// The picture as an SVG document of at most a few megabytes: the city from above around the track, which is coloured
/// by the number of satellites in line of sight; below it over time how many are in line of sight, reflected and
/// blocked, and the horizontal error. Of more epochs than pixels counts are averaged and of errors the largest drawn.
/// @param scene may be absent
std::string city_run_plot_svg(const CityRun& run, const UrbanScene* scene, const std::string& title);

}  // namespace skyloop::inline study
