#include "detail/number_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/core/number_in.hpp"

namespace skyloop {
namespace {

std::string_view table_trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\r");
    return first == text.npos ? std::string_view() : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

// Reads the cells of one line, or says what is wrong with it.
std::string read_cells(std::string_view line, std::size_t columns, std::array<double, 3>& values) {
    std::size_t count = 0;
    for (std::size_t at = 0; at <= line.size(); ++count) {
        const std::size_t comma = std::min(line.find(',', at), line.size());
        const std::string_view cell = table_trimmed(line.substr(at, comma - at));
        if (count == columns) return fmt::format("found more than {} columns", columns);
        const auto number = number_in<double>(cell);
        if (!number) return fmt::format("found \"{}\"; expected a number", cell.substr(0, 40));
        values[count] = *number;
        at = comma + 1;
    }
    return count == columns ? std::string() : fmt::format("found {} columns; expected {}", count, columns);
}

}  // namespace

Result<NumberTable> read_number_table(std::string_view text, std::string_view name,
                                      std::span<const std::string_view> headers) {
    NumberTable table;
    std::optional<std::size_t> columns;
    int number = 0;
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // as spreadsheets put it before UTF-8
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        const std::string_view line = table_trimmed(text.substr(at, end - at));
        at = end + 1;
        ++number;
        if (line.empty() || line.front() == '#') continue;
        if (!columns) {
            const auto known = std::find(headers.begin(), headers.end(), line);
            if (known == headers.end())
                return fail(ErrorCode::input, fmt::format("{}:{}: found \"{}\"; expected \"{}\"", name, number,
                                                          line.substr(0, 60), fmt::join(headers, "\" or \"")));
            table.header = static_cast<std::size_t>(known - headers.begin());
            columns = 1 + static_cast<std::size_t>(std::count(known->begin(), known->end(), ','));
            continue;
        }
        NumberRow row{number, {}};
        if (const std::string wrong = read_cells(line, *columns, row.values); !wrong.empty())
            return fail(ErrorCode::input, fmt::format("{}:{}: {}", name, number, wrong));
        table.rows.push_back(row);
    }
    if (table.rows.empty())
        return fail(ErrorCode::input,
                    fmt::format("{}:{}: found no rows; expected at least one line of numbers", name, number));
    return table;
}

}  // namespace skyloop
