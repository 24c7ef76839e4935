/// When a receiver's navigation epochs are.
#pragma once

#include <optional>

#include "base/time/gps_time.hpp"

namespace skyloop {

/// Epochs stand on a grid of GPS time: where the navigation period divides the week, the time of week is a multiple of
/// it. A period that changes gives a new grid, from the next epoch on (RECEIVER.md 4.4, 4.6): the first instant of the
/// new grid that has not passed and lies after the last epoch.
class EpochGrid {
public:
    /// Begins anew; the first epoch is at `now` or later.
    void start(GpsTime now, Nanoseconds period);
    /// Follows a period that may have changed by `now`. A period below a millisecond counts as one.
    void follow(GpsTime now, Nanoseconds period);
    /// The epoch at `next()` is had.
    void pass();
    [[nodiscard]] GpsTime next() const { return next_; }

private:
    Nanoseconds period_{1'000'000'000};
    GpsTime next_{};
    std::optional<GpsTime> last_;
};

}  // namespace skyloop
