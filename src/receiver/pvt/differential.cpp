#include "detail/differential.hpp"

#include <set>

#include "world/gnss/constants.hpp"

namespace skyloop {
namespace {

// Ours: 15 % of code noise and multipath is what is left of them in float solutions of the modern profile.
constexpr double share_of_code = 0.15;
constexpr std::size_t least_satellites = 5;
constexpr Seconds resolving{3};  // of tracking, until an ambiguity is known once others are

bool phase_serves(const Observation& o) {
    return o.pseudorange && o.carrier_phase && o.correction && o.correction->phase && o.half_cycle_resolved &&
           o.lock_time >= resolving;
}

Metres carrier_range(const Observation& o) {
    return Metres(*o.carrier_phase * speed_of_light / o.carrier.value()) - *o.correction->phase;
}

}  // namespace

CorrectionState correct(Observations& observations, CorrectionState wanted) {
    if (wanted == CorrectionState::none) return wanted;
    std::set<SatelliteId> serving;
    for (const Observation& o : observations.signals)
        if (phase_serves(o)) serving.insert(o.satellite);
    const bool phases = wanted != CorrectionState::differential && serving.size() >= least_satellites;
    const double of_code = wanted == CorrectionState::rtk_fixed ? 0 : share_of_code;
    for (Observation& o : observations.signals) {
        if (!o.pseudorange || !o.correction || (phases && !phase_serves(o))) {
            o.pseudorange.reset();
            continue;
        }
        o.pseudorange = *o.pseudorange - o.correction->code;
        if (!phases) continue;
        const Metres carrier = carrier_range(o);
        o.pseudorange = carrier + of_code * (*o.pseudorange - carrier);
    }
    return phases ? wanted : CorrectionState::differential;
}

}  // namespace skyloop
