#include "detail/table_cells.hpp"

#include <charconv>

namespace skyloop {

LineCells split_cells(std::string_view line, char separator) {
    LineCells cells;
    split_line(line, {&separator, 1}, separator == ' ', cells);
    return cells;
}

std::optional<double> cell_value(std::string_view cell) {
    if (cell.starts_with('+')) cell.remove_prefix(1);
    double value = 0;
    const auto [end, status] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (status != std::errc() || end != cell.data() + cell.size()) return std::nullopt;
    return value;
}

}  // namespace skyloop
