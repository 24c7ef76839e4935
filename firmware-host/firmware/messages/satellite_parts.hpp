/// What messages about satellites and about their signals share.
#pragma once

#include <vector>

#include "firmware/messages/field_values.hpp"

namespace skyloop::firmware {

/// NAV-SIG.
std::vector<Bytes> make_signal_message(const ReportContext& context);

/// Ascending by system and number, at most as many as a message can count.
std::vector<SatelliteStatus> sorted_satellites(const Fix& fix);

/// Where the corrections in the solution come from.
enum class CorrectionOrigin { none, sbas, rtcm3 };
CorrectionOrigin corrections_in_use(const NavigationState& state);

/// 0 unknown, 1 healthy, 2 unhealthy.
std::uint32_t satellite_health(const SatelliteStatus& s, const NavigationState& state);

/// qualityInd: 1 searched for, 2 acquired, 3 no range, 4 code locked, 6 and 7 carrier locked too. Models that measure
/// nothing track at 7.
std::uint32_t satellite_quality(const SatelliteStatus& s, const NavigationState& state);
std::uint8_t signal_quality(const Observation& observation);

}  // namespace skyloop::firmware
