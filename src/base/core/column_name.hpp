/// Names that tables of others give to their columns, with a unit.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace skyloop {

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

}  // namespace skyloop
