/// One number of many runs against another, with how it lies in ranges of the other.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "study/plot/svg_document.hpp"

namespace skyloop {

/// The runs with x from `low` to `high`.
struct TrendRange {
    double low = 0, high = 0;            ///< unit of x
    double p5 = 0, median = 0, p95 = 0;  ///< unit of y
};

struct TrendPlot {
    std::string x_axis, y_axis;  ///< names with units
    std::vector<SvgPoint> dots;  ///< x and y in their units
    std::vector<TrendRange> ranges;
    std::string title;
};

inline constexpr double trend_plot_width = 450;
inline constexpr double trend_plot_height = 300;
/// More dots than these are not drawn, but every k-th; the picture says so.
inline constexpr std::size_t most_trend_dots = 600;

/// The picture: dots, a band from the 5th to the 95th percentile and a line at the median of each range.
SvgDocument trend_plot(const TrendPlot& plot);

}  // namespace skyloop
