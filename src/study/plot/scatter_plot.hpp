/// Two clouds of horizontal position errors side by side, and how their errors are distributed.
#pragma once

#include <span>
#include <string>

#include "study/analysis/comparison.hpp"
#include "study/analysis/statistics.hpp"

namespace skyloop::inline study {

/// One cloud of the picture.
struct ScatterCloud {
    std::string name;  ///< above the panel
    PositionErrors errors;
};

inline constexpr double scatter_plot_width = 960;
inline constexpr double scatter_plot_height = 796;

/// The picture as an SVG document: the candidate left, the reference right, on one scale; the mean as a cross, the 95 %
/// ellipse of a normal distribution with the cloud's covariance, the circle that holds 95 % of the errors; histograms
/// of the error `quantity` below, each with the outline of the other. The caption tells the article's percentage and
/// the distances of both distributions of that quantity. Points outside the panels are counted in words.
std::string scatter_plot_svg(const ScatterCloud& candidate, const ScatterCloud& reference,
                             ErrorQuantity quantity = ErrorQuantity::horizontal);

/// Half-axes (m) and direction of the ellipse that holds 95 % of a normal distribution in the plane with the covariance
/// of the two series (k² = −2 ln 0.05).
struct ErrorEllipse {
    double major = 0, minor = 0;
    Angle azimuth;  ///< of the major axis, 0 … 180° clockwise from north
};
ErrorEllipse error_ellipse_95(std::span<const double> east, std::span<const double> north);

}  // namespace skyloop::inline study
