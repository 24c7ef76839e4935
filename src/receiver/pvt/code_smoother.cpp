#include "receiver/pvt/code_smoother.hpp"

#include <algorithm>

#include "world/gnss/constants.hpp"

namespace skyloop {
namespace {

// A gap after which nobody can say that no cycle was lost.
constexpr double longest_phase_gap_s = 5;

}  // namespace

void CodeSmoother::smooth(Observations& observations) {
    if (window_ <= Seconds(0)) return;
    if (observations.clock_was_set) signals_.clear();
    for (Observation& o : observations.signals) {
        const std::pair key(o.satellite, o.signal);
        if (!o.pseudorange || !o.carrier_phase) {
            signals_.erase(key);
            continue;
        }
        const auto known = signals_.find(key);
        const double dt =
            known == signals_.end() ? 0 : difference(observations.receive_time, known->second.time).value();
        if (dt <= 0 || dt > longest_phase_gap_s || o.slipped) {
            signals_[key] = {observations.receive_time, o.pseudorange->value(), *o.carrier_phase, 1};
            continue;
        }
        Smoothed& s = known->second;
        const double wavelength = speed_of_light / o.carrier.value();
        s.count = std::min(s.count + 1, std::max(window_.value() / dt, 1.0));
        const double carried = s.range + wavelength * (*o.carrier_phase - s.cycles);
        s.range = carried + (o.pseudorange->value() - carried) / s.count;
        s.cycles = *o.carrier_phase;
        s.time = observations.receive_time;
        o.pseudorange = Metres(s.range);
    }
}

}  // namespace skyloop
