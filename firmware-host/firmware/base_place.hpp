/// Where a base station stands.
#pragma once

#include <optional>

#include "base/core/units.hpp"
#include "base/geo/geodetic.hpp"
#include "firmware/base_survey.hpp"
#include "firmware/config/config_store.hpp"

namespace skyloop::firmware {

/// Told by CFG-TMODE-MODE 2, or found by a survey that is done.
struct BasePlace {
    Position<Ecef> position;
    Metres accuracy;  ///< 1 σ, CFG-TMODE-FIXED_POS_ACC or that of the survey
};

/// Nothing in the other modes, during a survey, and of boards that have no CFG-TMODE.
std::optional<BasePlace> base_place(const ConfigStore& config, const std::optional<BaseSurvey>& survey);

}  // namespace skyloop::firmware
