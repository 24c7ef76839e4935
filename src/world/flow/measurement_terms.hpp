/// What is true of the measurements and the receiver cannot know: each error of tracking by itself.
#pragma once

#include <vector>

#include "base/core/units.hpp"
#include "world/gnss/satellite.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop::inline world {

/// The errors of one tracked signal.
struct SignalTerms {
    SatelliteId satellite;
    Signal signal = Signal::l1;
    Metres code_noise;
    Metres multipath;        ///< of the code
    Metres false_code;       ///< that faults of the receiver add to the pseudorange
    Metres phase_multipath;  ///< of the carrier
    Metres phase_noise;      ///< of the carrier
    Hertz doppler_noise;     ///< of the carrier
};

/// All of one epoch; empty for models that measure nothing.
struct MeasurementTerms {
    Metres clock_bias;                 ///< receiver clock − GPST
    MetresPerSecond clock_drift;       ///< of it
    std::vector<SignalTerms> signals;  ///< in the order of the observations
};

}  // namespace skyloop::inline world
