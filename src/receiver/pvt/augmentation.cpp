#include "receiver/pvt/augmentation.hpp"

namespace skyloop::inline receiver {
namespace {

// Until fast and slow corrections and the ionosphere's grid have come round once, about: the grid alone may take 300 s
// (RTCA DO-229, table A-25), and receivers have what they need of it sooner. Ours.
constexpr Seconds collection{45};
constexpr Seconds kept{30};  // of the last message; fast corrections time out like that (DO-229, A.4.5)

constexpr int prn_of_first = 100;  // of S00

}  // namespace

void Augmentation::update(const Observations& observations, const ReceiverSettings& settings,
                          const std::optional<Geodetic>& place) {
    const GpsTime now = observations.receive_time;
    std::map<SatelliteId, GpsTime> tracked;
    for (const Observation& o : observations.signals) {
        if (o.satellite.constellation != Constellation::sbas || !o.pseudorange) continue;
        const auto known = tracked_since_.find(o.satellite);
        const GpsTime since = known == tracked_since_.end() ? now : known->second;
        tracked.emplace(o.satellite, since);
        const auto system = sbas_system(o.satellite.number + prn_of_first);
        if (system && place && difference(now, since) >= collection && skyloop::serves(*system, *place)) served_ = now;
    }
    tracked_since_ = std::move(tracked);
    serves_ = settings.sbas_corrections && served_ && difference(now, *served_) <= kept;
}

}  // namespace skyloop::inline receiver
