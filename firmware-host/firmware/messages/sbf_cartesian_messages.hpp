/// SBF blocks of the solution in ECEF, and of the sky.
#pragma once

#include "firmware/navigation_state.hpp"
#include "receiver/protocol/sbf_cartesian_blocks.hpp"

namespace skyloop::firmware {

/// What PVTGeodetic and its like tell, turned to the axes of ECEF.
SbfPvtCartesian sbf_pvt_cartesian(const ReportContext& context);
/// Nothing of a solution whose height is held: along no axis is its variance known then.
SbfPosCovCartesian sbf_position_covariance_cartesian(const NavigationState& state);
SbfVelCovCartesian sbf_velocity_covariance_cartesian(const NavigationState& state);
SbfBaseVectorCart sbf_base_vector_cartesian(const NavigationState& state);
/// Satellites above the horizon whose place is known, by their almanac or their ephemeris.
SbfSatVisibility sbf_visible_satellites(const NavigationState& state);

}  // namespace skyloop::firmware
