// What is read from a cell of a table, and from several of its rows.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "skyloop/base/result.hpp"
#include "skyloop/trajectory/track.hpp"

namespace skyloop {

// A line without blanks around it that is empty or a remark.
bool says_nothing(std::string_view plain);

// The first line of a text that holds a row; empty where none does.
std::string_view first_row_line(std::string_view text);

// A UTC time as ISO 8601 writes it; a zone may stand behind it (+01:00, +0100, +01).
Result<GpsTime> time_of_utc_cell(std::string_view text);

// Upwards, m/s, from the heights of the rows beside: the slope of the parabola through three of them, or of a line.
double climb_by_heights(const std::vector<TrackRow>& rows, std::size_t row);

}  // namespace skyloop
