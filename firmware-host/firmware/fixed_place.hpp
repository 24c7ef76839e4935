/// Where a base station was told that it stands.
#pragma once

#include <optional>

#include "firmware/config/config_store.hpp"
#include "skyloop/base/units.hpp"
#include "skyloop/geo/geodetic.hpp"

namespace skyloop::firmware {

/// A place by CFG-TMODE-MODE 2.
struct FixedPlace {
    Position<Ecef> position;
    Metres accuracy;  ///< 1 σ, CFG-TMODE-FIXED_POS_ACC
};

/// Nothing in the other modes, and of boards that have no CFG-TMODE.
std::optional<FixedPlace> fixed_place(const ConfigStore& config);

}  // namespace skyloop::firmware
