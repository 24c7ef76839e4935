/// How the values of many runs are distributed: a histogram and the empirical distribution function side by side.
/// One number of many runs against another, with how it lies in ranges of the other.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "study/plot/svg_document.hpp"

namespace skyloop::inline study {

/// A percentile with the interval that it lies in, in the unit of the values; an open end is nothing.
struct MarkedPercentile {
    double share = 0;  ///< 0 … 1
    double value = 0;
    std::optional<double> low, high;
};

struct DistributionPlot {
    std::string axis;                ///< "horizontal error, m"
    std::span<const double> sorted;  ///< finite, ascending, at least one
    double band = 0;                 ///< half the height of the band around the distribution function, 0 … 1
    std::vector<MarkedPercentile> percentiles;
};

inline constexpr double distribution_plot_width = 920;
inline constexpr double distribution_plot_height = 304;
/// More steps of the distribution function than these are not drawn; the picture says so.
inline constexpr std::size_t most_distribution_steps = 500;

/// The picture. Bins are as wide as Freedman and Diaconis (1981) advise, made round; of whole numbers each has its own.
/// What lies far beyond the quartiles is counted in words.
SvgDocument distribution_plot(const DistributionPlot& plot);

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

}  // namespace skyloop::inline study
