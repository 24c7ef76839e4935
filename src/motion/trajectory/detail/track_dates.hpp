/// Dates beside counted times, as in tables that have a column of each.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "motion/trajectory/track.hpp"

namespace skyloop {

/// Gathers what both clocks of a table say in its rows. State: these.
class TrackDates {
public:
    /// @param dated since the origin of GPS time
    void add(Nanoseconds counted, Nanoseconds dated);
    /// No row told both.
    [[nodiscard]] bool empty() const { return offsets_.empty(); }
    /// GPS time at which the count is 0: the middle of what the rows say, or where dates are cut to whole seconds the
    /// latest of it. Nothing where one row of ten is more than 2 s off: the clocks do not run together.
    [[nodiscard]] std::optional<Nanoseconds> of_count_zero() const;
    /// Makes counted times of rows times since the origin of GPS time, or leaves them; it is told by the names of both.
    void date(Track& track, const std::string& count, const std::string& date) const;

private:
    std::vector<Nanoseconds> offsets_;
    bool whole_seconds_ = true;
};

}  // namespace skyloop
