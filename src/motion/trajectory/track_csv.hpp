/// Tracks as tables of text.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/geo/geoid.hpp"
#include "motion/trajectory/track.hpp"

namespace skyloop::inline motion {

/// Reads a table whose first line names its columns (FEEDS.md 1.2; docs/scenario.md lists the names): a time, a place
/// and, when there, velocity and attitude. Columns are parted by comma, semicolon, tab or blanks; lines that begin with
/// `#` or `%` are comments; an empty cell or `nan` is absent. Rows without a time or a place are left out and told.
/// Names and units of other programs are understood where there is no name of ours: "Ground Speed [km/h]",
/// "altitude(feet)".
/// @param geoid for heights above sea level; null: a file with such heights fails
/// @param origin of local metres; nothing: a file with such places fails
/// Fails with `input`: NAME:LINE, the column, what was found and what was expected.
Result<Track> read_track_csv(std::string_view text, const std::string& name, const Geoid* geoid,
                             const std::optional<Geodetic>& origin = std::nullopt);

}  // namespace skyloop::inline motion
