/// Tables of numbers under a header line: antenna patterns.
#pragma once

#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"

namespace skyloop {

/// One line of numbers; a table has at most three columns.
struct NumberRow {
    int line = 0;
    std::array<double, 3> values{};
};

/// A table and which of the headers it has.
struct NumberTable {
    std::size_t header = 0;  ///< index among those that were allowed
    std::vector<NumberRow> rows;
};

/// Reads comma-separated numbers under one of `headers`. Empty lines and those that start with # are passed over. Fails
/// with `input` and FILE:LINE for another header, a cell that is no number, a line of another width, or no rows.
Result<NumberTable> read_number_table(std::string_view text, std::string_view name,
                                      std::span<const std::string_view> headers);

}  // namespace skyloop
