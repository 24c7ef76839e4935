// The cells of a table's line, and what is read from several of its rows.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "skyloop/base/result.hpp"
#include "skyloop/trajectory/track.hpp"

namespace skyloop {

using TrackCells = std::vector<std::string_view>;

// Without blanks and quotes around it.
std::string_view trimmed_track_cell(std::string_view text);
// Comma, semicolon or tabulator, the first of them that a header has; else a blank.
char track_separator(std::string_view header);
// A separator between double quotes separates nothing. With a blank as separator, several blanks and tabs count as one.
void split_track_cells(std::string_view line, char separator, TrackCells& cells);

// A UTC time as ISO 8601 writes it; a zone may stand behind it (+01:00, +0100, +01).
Result<GpsTime> time_of_utc_cell(std::string_view text);

// Upwards, m/s, from the heights of the rows beside: the slope of the parabola through three of them, or of a line.
double climb_by_heights(const std::vector<TrackRow>& rows, std::size_t row);

}  // namespace skyloop
