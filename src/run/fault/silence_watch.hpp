/// Which receivers of a run have fallen silent.
#pragma once

#include <cstddef>
#include <map>

#include "run/fault/run_observer.hpp"

namespace skyloop {

/// A receiver that has reported no epoch for so long tells its users nothing: what it said before is no fix of now.
inline constexpr Seconds silent_after{2};

/// Takes the epochs of a run. State: when each receiver reported last; before its first report the run's start.
class SilenceWatch {
public:
    explicit SilenceWatch(GpsTime start) : start_(start) {}

    /// @param now of the epoch; of one receiver it never goes back
    /// @return whether the receiver reports nothing of it, nor has for silent_after
    bool is_silent(const EpochSeen& seen, GpsTime now) {
        GpsTime& told_at = told_at_.try_emplace(seen.station, start_).first->second;
        if (seen.leaves) told_at = now;
        return difference(now, told_at) >= silent_after;
    }

private:
    GpsTime start_;
    std::map<std::size_t, GpsTime> told_at_;  // by station
};

}  // namespace skyloop
