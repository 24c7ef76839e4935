/// What monitor stations on the ground see of the orbits and clocks of GPS satellites.
#pragma once

#include <Eigen/Core>

#include <map>
#include <memory>
#include <vector>

#include "base/geo/geodetic.hpp"
#include "world/gnss/ephemeris.hpp"
#include "world/propagation/signal_in_space_error.hpp"
#include "world/sky/observe_sky.hpp"

namespace skyloop::inline world {

/// One satellite at one instant, in what messages can hold.
struct MonitoredSatellite {
    int iode = 0;                                       ///< of the record that is corrected
    Eigen::Vector3d orbit_m = Eigen::Vector3d::Zero();  ///< to be added to its position, ECEF
    double clock_s = 0;                                 ///< to be added to its clock
    double range_m = 0;                                 ///< to be added to a pseudorange then
    int udrei = 0;                                      ///< of the bound of what is left
};

/// Solves the errors of each satellite from the ranges of all stations that see it, at each whole minute for orbit and
/// slow clock, and at once for the rest. The records corrected are those that are sent at that minute: users keep the
/// one before until they hear of the new one.
///
/// State: what each station has observed, the errors' processes, and the corrections of the last minute.
class SatelliteMonitor {
public:
    /// What is true of the satellites, as every antenna of the run has it.
    struct Truth {
        std::shared_ptr<const NavigationSource> navigation;
        SignalInSpaceError error;
        std::shared_ptr<const PreciseTruth> precise{};  ///< null: the records, with `error` alone
    };
    SatelliteMonitor(Truth truth, const std::vector<Geodetic>& sites);
    /// Instants come in ascending order. Satellites that no station sees are absent.
    const std::map<SatelliteId, MonitoredSatellite>& at(GpsTime time);

private:
    struct Site {
        TruthState truth;
        SkyObserver observer;
    };
    // What one station sees of a satellite against the corrected record.
    struct SeenError {
        Eigen::Vector3d line;  // unit vector to the satellite, ECEF
        double range_m = 0;    // by which the range is longer
    };
    using SeenErrors = std::map<SatelliteId, std::vector<SeenError>>;
    struct LongTerm {
        Ephemeris record;
        MonitoredSatellite correction{};
    };
    [[nodiscard]] SeenErrors look(GpsTime time);
    [[nodiscard]] std::optional<double> range_over_record(const SatelliteInView& satellite, GpsTime time,
                                                          const Eigen::Vector3d& line) const;
    void begin_minute(GpsTime minute);

    std::shared_ptr<const NavigationSource> navigation_;  // of GPS alone
    SignalInSpaceError error_;
    std::shared_ptr<const PreciseTruth> precise_;
    std::vector<Site> sites_;
    std::optional<GpsTime> minute_, now_;
    std::map<SatelliteId, LongTerm> long_term_;
    std::map<SatelliteId, MonitoredSatellite> satellites_;
};

}  // namespace skyloop::inline world
