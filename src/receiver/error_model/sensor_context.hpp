/// What a sensor model knows besides its own parameters.
#pragma once

#include <cstdint>

#include "base/geo/geoid.hpp"
#include "base/time/utc_time.hpp"
#include "receiver/error_model/parameters.hpp"

namespace skyloop {

/// Shared by all sensor models of a run.
struct SensorContext {
    SelectionParameters selection;
    std::uint64_t seed = 1;
    const Geoid* geoid = nullptr;  ///< of the receiver; must outlive the model; without one the undulation is 0
    LeapSeconds leap_seconds = LeapSeconds::announced();
};

}  // namespace skyloop
