/// The vector from the base of a moving pair.
#pragma once

#include <deque>
#include <optional>
#include <set>

#include "receiver/pvt/baseline_solver.hpp"

namespace skyloop::inline receiver {

/// Solves the vector at the instants of the base's epochs, which come some time after this receiver's own of the same
/// instant: what the two measured then is differenced, whatever both have done since.
///
/// State: the epochs of the last seconds, and the solver's.
class MovingPair {
public:
    /// @param air standard atmosphere; outlives this
    MovingPair(const CarrierParameters& parameters, const RangeCorrections& air) : solver_(parameters, air) {}

    /// An epoch of this receiver; epochs come in ascending time. @param place solved by codes
    void remember(GpsTime time, const Observations& observations, const std::set<SatelliteId>& usable,
                  const Position<Ecef>& place);
    /// The vector at the base's epoch. @return nothing where no own epoch of that instant is remembered, where the base
    /// has no position, too few signals are common, or that epoch was solved before
    std::optional<RelativePosition> solve(const ReferenceStation& base, TransmitterSource& transmitters);
    /// What the last vector makes of a fix, float or fixed, for ten seconds.
    [[nodiscard]] std::optional<FixType> type_at(GpsTime time) const;
    void reset();

private:
    struct Remembered {
        GpsTime time;
        Observations observations;
        std::set<SatelliteId> usable;
        Position<Ecef> place;
    };
    BaselineSolver solver_;
    std::deque<Remembered> epochs_;
    std::optional<GpsTime> solved_;  // the base's last epoch
    std::optional<FixType> type_;    // of the vector then
};

}  // namespace skyloop::inline receiver
