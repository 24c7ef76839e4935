/// Code smoothed by the carrier.
#pragma once

#include <map>

#include "world/flow/observations.hpp"
#include "world/flow/receiver_settings.hpp"

namespace skyloop {

/// Hatch's filter for every signal: the mean of the code over a window, carried along by the phase (Hatch 1982).
///
/// State: of each signal the smoothed range, the phase it stood at, and for how long it has been smoothed.
class CodeSmoother {
public:
    /// @param window over which the code is averaged; 0: nothing is changed
    explicit CodeSmoother(Seconds window) : window_(window) {}
    /// Replaces the pseudoranges. A signal starts anew after a slip, a gap or without a locked phase, all of them when
    /// the receiver set its clock.
    void smooth(Observations& observations);
    void reset() { signals_.clear(); }

private:
    struct Smoothed {
        GpsTime time;
        double range = 0;   // m
        double cycles = 0;  // of the phase
        double count = 0;   // epochs
    };
    Seconds window_;
    std::map<std::pair<SatelliteId, Signal>, Smoothed> signals_;
};

}  // namespace skyloop
