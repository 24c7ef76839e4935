#include "skyloop/emulator/simulation.hpp"

#include "skyloop/propagation/free_space.hpp"
#include "skyloop/sky/observe_sky.hpp"

namespace skyloop {

SkyView Simulation::view(const TruthState& truth) const { return observe_sky(truth, *parts_.navigation); }

Trace Simulation::run(GpsTime time) {
    Trace trace;
    trace.truth = parts_.trajectory->at(time);
    trace.sky = view(trace.truth);
    trace.arrivals = free_space(trace.sky);
    for (const auto& effect : parts_.effects)
        effect->apply(trace.arrivals, trace.sky, trace.truth);
    trace.epoch.fix = parts_.error_model->fix(trace.truth, trace.sky, trace.arrivals);
    return trace;
}

}  // namespace skyloop
