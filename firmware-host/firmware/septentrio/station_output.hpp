/// What a Septentrio receiver sends to others as their reference station: RTCM 3 (mosaic-X5 reference guide,
/// firmware 4.14, setRTCMv3Output, setRTCMv3Interval, setRTCMv3Formatting).
#pragma once

#include <cstdint>
#include <vector>

#include "base/core/bytes.hpp"
#include "firmware/septentrio/console.hpp"

namespace skyloop::firmware {

/// Messages that are due at an epoch on the port of `context`: 1005 and 1006 of a receiver that was told where it
/// stands, 1007, 1008 and 1033 of its antenna as it was told, observations of kinds 4 to 7 and as 1001 to 1004 and 1009
/// to 1012, 1230, and the records of satellites that are tracked, as far as they have been received. Others may be
/// asked for and are left out.
std::vector<Bytes> station_output(const SeptentrioState& receiver, const ReportContext& context);

/// The longest period, ms, at which each of them that a port sends finds its epochs; 0 when none is sent.
std::uint64_t station_period_ms(const SeptentrioSettings& settings);

/// Whether a port sends records of satellites.
bool station_wants_records(const SeptentrioSettings& settings);

}  // namespace skyloop::firmware
