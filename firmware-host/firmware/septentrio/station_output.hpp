/// What a Septentrio receiver sends to others as their reference station: RTCM 3 (mosaic-X5 reference guide,
/// firmware 4.14, setRTCMv3Output, setRTCMv3Interval, setRTCMv3Formatting).
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "base/core/bytes.hpp"
#include "base/geo/geodetic.hpp"
#include "firmware/navigation_state.hpp"
#include "firmware/septentrio/settings.hpp"

namespace skyloop::firmware {

/// Messages that are due at an epoch on the port of `context`: 1005 and 1006 of a receiver that was told where it
/// stands, MSM4, MSM7 and 1230. Others may be asked for and are left out.
std::vector<Bytes> station_output(const SeptentrioSettings& settings, const ReportContext& context);

/// The longest period, ms, at which each of them that a port sends finds its epochs; 0 when none is sent.
std::uint64_t station_period_ms(const SeptentrioSettings& settings);

/// Whether a port sends a protocol: "SBF", "NMEA", "RTCMv3".
bool lets_through(const SeptentrioSettings& settings, std::string_view port, std::string_view protocol);

/// Where it stands, when PVTMode says that it does and the position of which it speaks has been set.
std::optional<Position<Ecef>> told_place(const SeptentrioSettings& settings);

}  // namespace skyloop::firmware
