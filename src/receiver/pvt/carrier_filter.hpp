/// Carrier phases of two receivers against each other: floating ambiguities, then whole ones.
#pragma once

#include <Eigen/Core>

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/core/units.hpp"
#include "base/time/gps_time.hpp"
#include "receiver/pvt/navigation_parameters.hpp"
#include "world/gnss/satellite.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop::inline receiver {

/// One signal as this receiver measured it, less as the reference did: of both the computed distance, the satellite's
/// clock and a standard atmosphere's troposphere are out.
struct SingleDifference {
    SatelliteId satellite;
    Signal signal = Signal::l1;
    double wavelength_m = 0;
    double code_m = 0;
    double phase_m = 0;    ///< cycles times wavelength
    Eigen::Vector3d line;  ///< unit vector receiver to satellite, ECEF
    Angle elevation;
    double code_variance = 0, phase_variance = 0;  ///< m², of both ends together
    double echo_variance = 0;                      ///< the same, of the errors of the phase that last
    double ionosphere_factor = 1;                  ///< its delay over that at GPS L1
    double wet_mapping = 1;                        ///< slant over zenith
    bool broken = false;                           ///< a count of cycles began anew at either end
    Seconds tracked;                               ///< by both ends without a break, as they tell it
    bool whole = true;                             ///< its ambiguity is a whole number
};

/// How far apart the two stand.
struct Spacing {
    double length_m = 0;
    double height_m = 0;  ///< this receiver above the reference
};

/// Against the place for which the differences were computed, ECEF, m.
struct CarrierOffset {
    Eigen::Vector3d offset = Eigen::Vector3d::Zero();
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// The same with whole ambiguities.
struct FixedOffset : CarrierOffset {
    double ratio = 0;  ///< of the second best set to the best
    int ambiguities = 0;
};

/// A Kalman filter over double differences. Its parts: the place of this receiver, forgotten with each epoch; by how
/// much more the wet air delays it at the zenith; the ionosphere's difference for each satellite; an ambiguity for each
/// signal. All are single differences, so that the satellite to which the others are compared may change (RTKLIB manual
/// 2.4.2, E.7). A code counts fully once for an ambiguity, and after that by how long its errors last. What echoes do
/// to a phase lasts, too: an ambiguity in the filter is a whole number of cycles and that, so it wanders, and is whole
/// only to within so much.
///
/// State: that, and which whole ambiguities are held.
class CarrierFilter {
public:
    explicit CarrierFilter(const CarrierParameters& parameters);
    ~CarrierFilter();

    /// One epoch; epochs come in ascending time. @return nothing for fewer than four satellites, and where the phases
    /// contradict the codes, or have contradicted what was known for some epochs: then all begins anew with the next
    std::optional<CarrierOffset> update(std::span<const SingleDifference> differences, const Spacing& spacing,
                                        GpsTime time);
    /// With the whole ambiguities of the last epoch, of all its signals or of part of them, once these pass the tests;
    /// after some time they are held.
    std::optional<FixedOffset> fix();
    void reset();

private:
    class State;
    CarrierParameters parameters_;
    std::unique_ptr<State> state_;
};

}  // namespace skyloop::inline receiver
