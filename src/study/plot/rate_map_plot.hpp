/// Rates over a grid of two parameters, as coloured cells.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "study/plot/svg_document.hpp"

namespace skyloop {

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

}  // namespace skyloop
