/// Lines of tables as text: their cells, and what stands between them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace skyloop {

using LineCells = std::vector<std::string_view>;

/// Without blanks, line ends and quotation marks around it.
std::string_view trimmed_cell(std::string_view text);

/// Comma, semicolon or tabulator, the first of them that the line has; else a blank.
char separator_in(std::string_view line);

/// The cells between `separators`, each trimmed_cell(). In a cell that begins with a double quote a separator between
/// two of them separates nothing (RFC 4180, section 2); any other quote is a letter, as that of seconds of arc. @param
/// runs several in a row count as one
void split_line(std::string_view line, std::string_view separators, bool runs, LineCells& cells);

/// The same at the separator of a table. Where it is a blank, several blanks and tabs count as one, and those around
/// the line as none.
void split_table_line(std::string_view line, char separator, LineCells& cells);

/// What is wrong with a row that has more cells than there are names: a decimal comma made two of one. Empty cells at
/// its end do not count. Nothing: it fits.
std::optional<std::string> width_mistake(const LineCells& cells, std::size_t names);

}  // namespace skyloop
