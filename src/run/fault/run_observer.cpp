#include "run/fault/run_observer.hpp"

#include <algorithm>

#include "base/geo/local_frame.hpp"

namespace skyloop::inline run {
namespace {

// What the receiver tracks of a satellite; a sensor model measures nothing, and its C/N0 is that of its report.
std::vector<std::pair<Signal, DbHz>> tracked_signals(const EpochSeen& seen, const SatelliteStatus* status,
                                                     SatelliteId id) {
    std::vector<std::pair<Signal, DbHz>> signals;
    for (const Observation& one : seen.trace.epoch.observations.signals)
        if (one.satellite == id) signals.emplace_back(one.signal, one.cn0);
    if (signals.empty() && status != nullptr && status->cn0)
        signals.emplace_back(first_signal(id.constellation), *status->cn0);
    return signals;
}

const SatelliteStatus* reported_satellite(const EpochSeen& seen, SatelliteId id) {
    const auto& reported = seen.reported.epoch.fix.satellites;
    const auto found = std::find_if(reported.begin(), reported.end(), [&](const auto& s) { return s.id == id; });
    return found == reported.end() ? nullptr : &*found;
}

SatelliteSeen satellite_seen(const EpochSeen& seen, std::size_t index) {
    const SatelliteInView& view = seen.trace.sky.satellites[index];
    SatelliteSeen shown;
    shown.id = view.id;
    shown.azimuth = view.azimuth;
    shown.elevation = view.elevation;
    shown.healthy = view.healthy;
    if (index < seen.trace.arrivals.satellites.size() && seen.trace.arrivals.satellites[index].id == view.id) {
        const Arrival& arrival = seen.trace.arrivals.satellites[index];
        shown.state = reception_of(arrival);
        shown.paths = arrival.paths;
    }
    const SatelliteStatus* status = reported_satellite(seen, view.id);
    shown.used = status != nullptr && status->used;
    shown.signals = tracked_signals(seen, status, view.id);
    return shown;
}

}  // namespace

std::vector<SatelliteSeen> satellites_seen(const EpochSeen& seen) {
    std::vector<SatelliteSeen> all;
    all.reserve(seen.trace.sky.satellites.size());
    for (std::size_t i = 0; i < seen.trace.sky.satellites.size(); ++i)
        all.push_back(satellite_seen(seen, i));
    return all;
}

EnuError enu_error(const TruthState& truth, const Fix& fix) {
    const Eigen::Vector3d error = LocalFrame(truth.geodetic).to_enu(to_ecef(fix.position)).vector();
    return {Metres(error.x()), Metres(error.y()), Metres(error.z())};
}

}  // namespace skyloop::inline run
