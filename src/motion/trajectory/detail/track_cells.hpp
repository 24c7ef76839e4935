// What is read from a cell of a table, and from several of its rows.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "motion/trajectory/track.hpp"
#include "track_columns.hpp"

namespace skyloop {

// A line without blanks around it that is empty or a remark.
bool says_nothing(std::string_view plain);

// The first line of a text that holds a row; empty where none does.
std::string_view first_row_line(std::string_view text);

// A UTC time as ISO 8601 writes it; a zone may stand behind it (+01:00, +0100, +01).
Result<GpsTime> time_of_utc_cell(std::string_view text);

// A cell that holds nothing.
bool is_absent(std::string_view text);

// What is wrong with a place that is not near the ground; nothing: it is.
std::optional<std::string> mistake_of_place(const Position<Ecef>& place);

// The number that the whole of a cell is, in the unit of its column's quantity. Latitudes and longitudes in degrees may
// have a letter, minutes and seconds. Nothing for any other text.
std::optional<double> number_of_cell(std::string_view text, const TrackColumn& column, TrackQuantity quantity);

}  // namespace skyloop
