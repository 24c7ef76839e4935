#include "run/fault/lost_cycles.hpp"

#include <algorithm>

#include "world/gnss/constants.hpp"

namespace skyloop {

void LostCycles::follow(const Observations& observations) {
    std::map<Key, Count> kept;
    for (const Observation& o : observations.signals) {
        if (counts_.empty() || !o.carrier_phase || o.slipped) continue;
        const auto found = counts_.find({o.satellite, o.signal});
        if (found == counts_.end()) continue;
        found->second.hidden = false;
        kept.insert(*found);
    }
    counts_ = std::move(kept);
}

void LostCycles::slip(const Observation& observation, GpsTime now, double cycles, bool noticed) {
    Count& count = counts_[{observation.satellite, observation.signal}];
    count.cycles += cycles;
    if (noticed) count.noticed = now;
}

void LostCycles::hide(const Observation& observation) {
    const auto found = counts_.find({observation.satellite, observation.signal});
    if (found != counts_.end()) found->second.hidden = true;
}

void LostCycles::apply(Observations& observations, GpsTime now) {
    if (counts_.empty()) return;
    for (Observation& o : observations.signals) {
        const auto found = counts_.find({o.satellite, o.signal});
        if (found == counts_.end() || !o.carrier_phase) continue;
        Count& count = found->second;
        *o.carrier_phase += count.cycles;
        if (!count.hidden) count.resolved = count.cycles;
        if (o.correction && o.correction->phase)
            *o.correction->phase += Metres(count.resolved * speed_of_light / o.carrier.value());
        if (count.noticed) o.lock_time = std::min(o.lock_time, difference(now, *count.noticed));
    }
}

}  // namespace skyloop
