#include "table_cells.hpp"

#include <charconv>

#include "skyloop/base/cell_end.hpp"

namespace skyloop {

std::string_view without_blanks(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\r\"");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r\"") - first + 1);
}

std::vector<std::string_view> split_cells(std::string_view line, char separator) {
    std::vector<std::string_view> cells;
    for (;;) {
        const std::size_t end = end_of_cell(line, {&separator, 1});
        cells.push_back(without_blanks(line.substr(0, end)));
        if (end == std::string_view::npos) return cells;
        line.remove_prefix(end + 1);
        while (separator == ' ' && line.starts_with(' '))
            line.remove_prefix(1);
    }
}

std::optional<double> cell_value(std::string_view cell) {
    if (cell.starts_with('+')) cell.remove_prefix(1);
    double value = 0;
    const auto [end, status] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (status != std::errc() || end != cell.data() + cell.size()) return std::nullopt;
    return value;
}

}  // namespace skyloop
