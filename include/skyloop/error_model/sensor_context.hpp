/// What a sensor model knows besides its own parameters.
#pragma once

#include <cstdint>

#include "skyloop/error_model/parameters.hpp"
#include "skyloop/geo/geoid.hpp"
#include "skyloop/time/utc_time.hpp"

namespace skyloop {

/// Shared by all sensor models of a run.
struct SensorContext {
    SelectionParameters selection;
    std::uint64_t seed = 1;
    const Geoid* geoid = nullptr;  ///< of the receiver; must outlive the model; without one the undulation is 0
    LeapSeconds leap_seconds = LeapSeconds::announced();
};

}  // namespace skyloop
