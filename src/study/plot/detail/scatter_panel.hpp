/// One half of the picture of two clouds: where it lies and what is drawn of it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "study/analysis/comparison.hpp"
#include "study/plot/scatter_plot.hpp"
#include "study/plot/svg_document.hpp"

namespace skyloop::inline study {

// Measures of the picture, pixels.
inline constexpr double panel_width = 400;
inline constexpr double panel_left = 68;
inline constexpr double panel_gap = 56;
inline constexpr double cloud_top = 122;
inline constexpr double cloud_size = 400;
inline constexpr double histogram_top = 600;
inline constexpr double histogram_height = 130;

struct ScatterPanel {
    const ScatterCloud& cloud;
    std::string_view colour;
    double left = 0;  ///< pixels
    std::optional<SampleStatistics> east, north, horizontal;
    ErrorQuantity quantity = ErrorQuantity::horizontal;  ///< of the histogram
    std::optional<SampleStatistics> chosen;              ///< statistics of that quantity
};

/// The largest of `sizes` but the wildest one in 500; 0 of none.
double all_but_wildest(std::vector<double> sizes);

/// A number on an axis whose marks are `step` apart.
std::string scatter_tick(double value, double step);

/// "horizontal error", "3D error", "up error".
std::string error_axis_name(ErrorQuantity quantity);

/// Both histograms of the chosen quantity on one scale, each with the outline of the other; `reach` metres are as far
/// as the clouds are shown.
void draw_error_histograms(SvgDocument& svg, const ScatterPanel& a, const ScatterPanel& b, double reach);

}  // namespace skyloop::inline study
