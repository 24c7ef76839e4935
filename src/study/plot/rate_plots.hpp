/// One row for each of some things: how often it passed, or how its values lie.
/// Rates over a grid of two parameters, as coloured cells.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "study/plot/svg_document.hpp"

namespace skyloop::inline study {

/// A rate with its interval, shares 0 … 1.
struct RateRow {
    std::string label;
    double share = 0, low = 0, high = 1;
    std::size_t passed = 0, trials = 0;  ///< without trials only the label is drawn
};

/// The values of one level, in their unit; whiskers at the 5th and the 95th percentile.
struct BoxRow {
    std::string label;
    double p5 = 0, p25 = 0, median = 0, p75 = 0, p95 = 0;
    std::size_t count = 0;  ///< without values only the label is drawn
};

inline constexpr double level_plot_width = 450;
/// Of a picture over the whole width of a page.
inline constexpr double wide_plot_width = 920;

/// Dots with intervals on an axis in percent, which begins at 0, 50, 80, 90 or 98: the largest that shows all of them.
SvgDocument rate_rows_plot(std::span<const RateRow> rows, const std::string& title, double width);

/// Boxes from the first to the third quartile with the median; the axis holds all of them.
SvgDocument box_rows_plot(std::span<const BoxRow> rows, const std::string& axis, const std::string& title);

struct RateCell {
    std::size_t passed = 0, trials = 0;  ///< without trials the cell stays empty
    double low = 0, high = 1;            ///< interval of the rate, shares 0 … 1
};

struct RateMap {
    std::string title;
    std::string column_axis, row_axis;       ///< names of the parameters
    std::vector<std::string> columns, rows;  ///< labels; rows from below
    std::vector<RateCell> cells;             ///< row by row
};

inline constexpr double rate_map_width = 450;

/// The picture. Each cell tells its rate in percent, and on being pointed at its counts and interval.
SvgDocument rate_map_plot(const RateMap& map);

}  // namespace skyloop::inline study
