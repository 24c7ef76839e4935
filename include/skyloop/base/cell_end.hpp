/// Where a cell ends in a line of a table.
#pragma once

#include <cstddef>
#include <string_view>

namespace skyloop {

/// The end of the cell that a line begins with: the first of `separators` that does not stand between double quotes;
/// npos: it is the last cell. A quote without its other half is a letter.
inline std::size_t end_of_cell(std::string_view line, std::string_view separators) {
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (line[i] == '"') quoted = !quoted;
        if (!quoted && separators.find(line[i]) != std::string_view::npos) return i;
    }
    return quoted ? line.find_first_of(separators) : std::string_view::npos;
}

}  // namespace skyloop
