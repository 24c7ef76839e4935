/// Rows of which their recorder did not know the place, and speeds in another unit (FEEDS.md 1.5).
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "motion/trajectory/track.hpp"

namespace skyloop {

/// Takes out the rows at latitude 0, longitude 0, where recorders put places that they do not know, unless all are
/// there. A jump of such a row is that of the next one. Says what was done, of so many rows of the file; empty:
/// nothing.
std::string leave_out_zero_places(Track& track, std::size_t rows);

/// Upwards, m/s, from the heights of the rows beside that are at most 30 s away: the slope of the parabola through
/// three of them, or of a line.
double climb_by_heights(std::span<const TrackRow> rows, std::size_t row);

/// The middle ratio of the speeds that rows tell to those of their places, where the vehicle moves; nothing where too
/// few tell one.
std::optional<double> speed_ratio(std::span<const TrackRow> rows);

/// Takes the velocities from rows whose speeds are in another unit than metres per second, by that ratio. Says so;
/// empty: they are not.
std::string leave_out_foreign_speeds(Track& track);

}  // namespace skyloop
