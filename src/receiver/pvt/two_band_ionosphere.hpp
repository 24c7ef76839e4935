/// The ionosphere as the two carriers of a satellite show it.
#pragma once

#include <map>
#include <optional>
#include <span>

#include "receiver/pvt/single_point.hpp"
#include "receiver/pvt/transmitter.hpp"
#include "world/flow/observations.hpp"

namespace skyloop::inline receiver {

/// Measures the slant delay of each satellite: (P₂ − P₁)/((f₁/f₂)² − 1) of the codes at the first carrier, the
/// satellite's group delays taken off, averaged along the change that the phases show (Hatch 1982). A slip costs the
/// change of one epoch alone, which is millimetres.
///
/// State: of each satellite the average, the phases that it stood at, and for how long it has been averaged.
class TwoBandIonosphere {
public:
    /// @param memory over which the codes are averaged; 0: nothing is measured
    explicit TwoBandIonosphere(Seconds memory) : memory_(memory) {}

    /// Of one epoch. @param first with a pseudorange, sent as `sent` says @param others of the same satellite, each
    /// with a pseudorange: the first of them on another carrier is compared with it  @return nothing where there is
    /// none, or its group delay is not known
    std::optional<MeasuredDelay> measure(TransmitterSource& transmitters, const Transmitter& sent,
                                         const Observation& first, std::span<const Observation* const> others,
                                         GpsTime receive_time);
    void reset() { satellites_.clear(); }

private:
    struct Average {
        GpsTime time;
        double delay = 0;               // m
        std::optional<double> phase{};  // m, of the second carrier less the first
        double averaged = 0;            // s
    };
    void average(Average& known, double code, std::optional<double> phase, double per_phase, GpsTime time) const;

    Seconds memory_;
    std::map<SatelliteId, Average> satellites_;
};

}  // namespace skyloop::inline receiver
