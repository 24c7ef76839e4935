/// Cycles that a receiver's counts of the carrier have lost or won.
#pragma once

#include <map>
#include <optional>
#include <utility>

#include "world/flow/observations.hpp"

namespace skyloop {

/// What faults have done to the counts of one receiver. A count that has slipped stays wrong when its fault is over,
/// until the receiver counts the signal anew.
///
/// State: the counts that are off.
class LostCycles {
public:
    /// Before the faults of an epoch: forgets signals that are counted anew, or not at all.
    void follow(const Observations& observations);
    /// A count breaks by so many cycles. @param noticed the receiver knows it at once
    void slip(const Observation& observation, GpsTime now, double cycles, bool noticed);
    /// In this epoch the receiver does not know that the count is off.
    void hide(const Observation& observation);
    /// After the faults of an epoch: puts what was lost into phases and lock times. What the receiver knows of, or no
    /// fault hides any longer, is part of the ambiguities that it finds anew.
    void apply(Observations& observations, GpsTime now);
    [[nodiscard]] bool empty() const { return counts_.empty(); }

private:
    struct Count {
        double cycles = 0;
        double resolved = 0;               // of them, in the ambiguity that the receiver goes by
        std::optional<GpsTime> noticed{};  // the last slip that it saw
        bool hidden = false;
    };
    using Key = std::pair<SatelliteId, Signal>;

    std::map<Key, Count> counts_;
};

}  // namespace skyloop
