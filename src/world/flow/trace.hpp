/// Everything of one epoch, for tests, recordings and displays.
#pragma once

#include <optional>

#include "world/flow/arrivals.hpp"
#include "world/flow/epoch.hpp"
#include "world/flow/error_scale.hpp"
#include "world/flow/measurement_terms.hpp"
#include "world/flow/sky_view.hpp"
#include "world/flow/truth_state.hpp"

namespace skyloop::inline world {

/// All values of one epoch. The receiver is handed `epoch` and nothing else.
struct Trace {
    TruthState truth;
    SkyView sky;
    Arrivals arrivals;
    MeasurementTerms measurement;
    Epoch epoch;
    std::optional<UereScale> error_scale;  ///< of the fix of a sensor model that makes one of DOP and range errors
    bool measures = false;  ///< by a receiver that measures, though it may track nothing just now; sensor models do not
};

}  // namespace skyloop::inline world
