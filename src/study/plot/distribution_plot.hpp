/// How the values of many runs are distributed: a histogram and the empirical distribution function side by side.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "study/plot/svg_document.hpp"

namespace skyloop {

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

}  // namespace skyloop
