/// Code smoothed by the carrier.
/// What a receiver makes of the ranges of one satellite.
#pragma once

#include <map>
#include <optional>
#include <span>

#include "receiver/pvt/single_point.hpp"
#include "receiver/pvt/transmitter.hpp"
#include "world/flow/observations.hpp"
#include "world/flow/receiver_settings.hpp"

namespace skyloop::inline receiver {

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

/// The equation of a pseudorange, or of the combination of two that the ionosphere does not touch: of frequencies f₁
/// and f₂, (f₁² P₁ − f₂² P₂)/(f₁² − f₂²) (IS-GPS-200, 20.3.3.3.3.3 without its group delays, which the transmitters
/// know).
/// @param first with a pseudorange @param others of the same satellite, each with a pseudorange: the first of them on
/// another carrier whose group delay is known is combined with it  @return nothing where no orbit is known
std::optional<RangeEquation> range_equation(TransmitterSource& transmitters, const Observation& first,
                                            std::span<const Observation* const> others, GpsTime receive_time);

}  // namespace skyloop::inline receiver
