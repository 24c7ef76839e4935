/// This receiver against a reference station, by codes and by carrier phases.
#pragma once

#include <Eigen/Core>

#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "base/geo/frames.hpp"
#include "receiver/pvt/carrier_filter.hpp"
#include "receiver/pvt/corrections.hpp"
#include "receiver/pvt/navigation_parameters.hpp"
#include "receiver/pvt/transmitter.hpp"
#include "world/flow/epoch.hpp"
#include "world/flow/observations.hpp"
#include "world/flow/reference_station.hpp"

namespace skyloop::inline receiver {

/// Takes off each pseudorange what the reference's pseudorange of the same signal is longer than the distance from
/// where it says it stands, its clock's share aside (RTCM 10402.3, differential corrections): errors of orbits, clocks
/// and air that both see. Pseudoranges without a correction are taken away.
/// @return how many satellites have a corrected pseudorange; below 4 nothing has been changed
int correct_codes(Observations& observations, const ReferenceStation& reference, TransmitterSource& transmitters);

/// What is known when a baseline is solved.
struct BaselineInput {
    GpsTime time;                         ///< of the epoch
    const Observations& observations;     ///< as measured
    const ReferenceStation& reference;    ///< with a position
    Position<Ecef> place;                 ///< of this receiver, to some metres
    const std::set<SatelliteId>& usable;  ///< satellites that agree with the solution by codes
    bool may_fix = true;                  ///< ambiguities to whole numbers
};

/// A solved baseline.
struct BaselineSolution {
    Position<Ecef> position;     ///< of this receiver, as the reference's told one has it
    Displacement<Ecef> vector;   ///< from the reference
    Eigen::Matrix3d covariance;  ///< of both, ECEF, m²
    bool fixed = false;          ///< the ambiguities are whole numbers
    double ratio = 0;            ///< of the ratio test; 0 while they float
    int ambiguities = 0;         ///< that were fixed
    int satellites = 0;          ///< that both have
    Seconds age;                 ///< of the reference's data
};

/// As messages tell it: at the reference, north, east and down.
RelativePosition relative_position(const BaselineSolution& solution, const ReferenceStation& reference);

/// Differences what both measured, and solves them by carrier phases. Data of the reference that are older than the
/// epoch count as they are: what its clock and satellites have done since is known, and what the air has is noise.
///
/// State: the filter, which begins anew with another reference, and until when each phase of that has been counted
/// without a break.
class BaselineSolver {
public:
    /// @param air standard atmosphere; outlives this
    BaselineSolver(const CarrierParameters& parameters, const RangeCorrections& air)
        : parameters_(parameters), air_(air), filter_(parameters) {}

    /// @return nothing where too few signals are common
    std::optional<BaselineSolution> solve(const BaselineInput& input, TransmitterSource& transmitters);
    void reset();

private:
    using Key = std::pair<SatelliteId, Signal>;
    struct Counted {
        GpsTime time;
        Seconds lock;
    };
    std::vector<SingleDifference> differences(const BaselineInput& input, TransmitterSource& transmitters);
    bool reference_broke(const Observation& o, GpsTime time);

    CarrierParameters parameters_;
    const RangeCorrections& air_;
    CarrierFilter filter_;
    std::optional<int> station_;      // the reference's number
    std::map<Key, Counted> counted_;  // of the reference
    std::map<Key, GpsTime> own_;      // when this receiver's phase was last seen
};

}  // namespace skyloop::inline receiver
