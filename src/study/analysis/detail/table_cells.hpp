/// Cells of a line of a table.
#pragma once

#include <optional>
#include <string_view>

#include "base/core/table_line.hpp"

namespace skyloop {

/// The cells of a line, each without blanks around it. A separator between double quotes separates nothing. With a
/// space as `separator` several count as one.
LineCells split_cells(std::string_view line, char separator);

/// The number that a cell is, or nothing.
std::optional<double> cell_value(std::string_view cell);

}  // namespace skyloop
