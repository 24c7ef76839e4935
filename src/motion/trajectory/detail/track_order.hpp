// Rows of a recorded path in one order of time (FEEDS.md 1.14), and what its cleaning tells of them.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "motion/trajectory/track.hpp"

namespace skyloop::inline motion {

using TrackRows = std::vector<TrackRow>;

// Of a row from the others or the origin of its times, and of a whole track without dates: sums and differences of such
// times are times, too.
inline constexpr Nanoseconds longest_track_time = std::chrono::hours(24 * 365 * 70);

// What cleaning has left out or changed, and where it did so first.
class TouchedRows {
public:
    void add(const TrackRow& row);
    // "3 rows …, first in line 7", when there are any.
    void tell(Track& track, std::string_view what) const;

private:
    std::size_t count_ = 0;
    std::string first_line_;
};

// From one row to the next, where the time rises at all; a second where it never does.
Nanoseconds median_step(const TrackRows& rows);

// Rows whose times nowhere fall. Rows with dates are of one clock and keep their times: parts of them are put in its
// order, single rows only where their places fit there. Times that count from the file's own start may begin anew.
void put_rows_in_order(Track& track);

}  // namespace skyloop::inline motion
