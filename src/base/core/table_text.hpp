/// Lines of tables as text: their cells, and what stands between them.
/// Names that tables of others give to their columns, with a unit.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace skyloop::inline base {

using LineCells = std::vector<std::string_view>;

/// Without blanks, line ends and quotation marks around it.
std::string_view trimmed_cell(std::string_view text);

/// Whether a cell holds nothing: it is empty, or "nan" as programs write what they do not know.
bool is_absent(std::string_view cell);

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

/// What the numbers of a column measure.
enum class Measured {
    time,      ///< s
    calendar,  ///< a date and a time of day
    angle,     ///< deg
    length,    ///< m
    speed      ///< m/s
};

/// A name in lower case with underscores for blanks and hyphens, and the unit that it tells; empty: none.
struct ColumnName {
    std::string name, unit;
};

/// "Ground Speed [km/h]" is "ground_speed" and "km/h", "Latitude" is "latitude" without a unit.
ColumnName bracketed_column_name(std::string_view text);

/// The same; where no brackets are, the last word is the unit: "alt_ft" is "alt" and "ft".
ColumnName column_name(std::string_view text);

/// What numbers in a unit are multiplied by: to seconds, degrees, metres or metres a second; nothing for a unit that is
/// not known, or of something else. Dates and times of day have the one unit "utc".
std::optional<double> unit_scale(std::string_view unit, Measured measured);

}  // namespace skyloop::inline base
