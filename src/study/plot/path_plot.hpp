/// A path from above, and its height and speed over time.
#pragma once

#include <span>
#include <string>

#include "motion/trajectory/path_survey.hpp"

namespace skyloop::inline study {

inline constexpr double path_plot_width = 720;
inline constexpr double path_plot_height = 860;

/// The picture as an SVG document: the way over the ground in the tangent plane at its beginning, north up, coloured by
/// speed, with a scale, its beginning and its end marked; below it the height above the ellipsoid and the speed against
/// time. Where the path jumps the lines are broken.
/// @param samples ascending in time, evenly spaced; a few thousand at most make sense
std::string path_plot_svg(std::span<const PathSample> samples, const std::string& title);

}  // namespace skyloop::inline study
