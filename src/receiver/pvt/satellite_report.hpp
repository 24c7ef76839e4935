/// The satellites as the receiver lists them.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "receiver/pvt/received_records.hpp"
#include "receiver/pvt/single_point.hpp"
#include "world/flow/fix.hpp"
#include "world/flow/observations.hpp"

namespace skyloop {

/// What the list is made of.
struct ReportInput {
    const Observations& observations;
    GpsTime time;
    std::optional<Position<Ecef>> position{};           ///< of the receiver, as far as it knows
    std::span<const RangeEquation> equations{};         ///< of this epoch
    const std::vector<RangeOutcome>* ranges = nullptr;  ///< what became of them, in the same order
};

/// Lists every satellite that is tracked, and those above the horizon that the receiver knows by record or almanac.
///
/// State: the satellites that may stand above the horizon, looked up at every half minute of GPS time.
class SatelliteReport {
public:
    /// @param sent what the almanac knows  @param received what the receiver does; both outlive this
    SatelliteReport(const NavigationSource& sent, const ReceivedRecords& received) : sent_(sent), received_(received) {}
    /// Ascending. A tracked satellite of unknown orbit stands at azimuth and elevation 0.
    std::vector<SatelliteStatus> list(const ReportInput& input);
    void reset() { looked_up_.reset(); }

private:
    struct Candidate {
        SatelliteId id;
        Ephemeris record;  // carried to the instant of the last look
    };
    void look_up(GpsTime time, const Position<Ecef>& position);
    void add_tracked(const ReportInput& input, std::vector<SatelliteStatus>& list) const;
    void add_untracked(const ReportInput& input, std::vector<SatelliteStatus>& list) const;

    const NavigationSource& sent_;
    const ReceivedRecords& received_;
    std::optional<GpsTime> looked_up_;
    std::vector<Candidate> candidates_;  // ascending
};

}  // namespace skyloop
