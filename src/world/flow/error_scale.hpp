/// How large a sensor model makes the error of its fix.
#pragma once

#include "base/core/units.hpp"

namespace skyloop::inline world {

/// The scale of an epoch's position error (MODELS.md 3.9).
struct UereScale {
    Metres sigma_uere;      ///< spread of the satellites' range errors
    Metres position_error;  ///< E = PDOP·σ_uere, three-dimensional
};

}  // namespace skyloop::inline world
