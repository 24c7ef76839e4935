/// BeiDou D1 navigation subframes of MEO and IGSO satellites (BDS-SIS-ICD B1I 3.0, section 5.2).
#pragma once

#include <array>
#include <cstdint>

#include "world/gnss/ephemeris.hpp"
#include "world/gnss/navigation_source.hpp"

namespace skyloop {

/// Ten words as u-blox hands them out [seen in captures]: 30 bits in bits 29 … 0, the interleaving undone: 26 or 22
/// bits of information, then 4 or twice 4 of parity.
using D1Words = std::array<std::uint32_t, 10>;

/// Subframes 1 to 3: clock, ionosphere and ephemeris (figures 5-8 to 5-10, tables 5-6 to 5-13). Values that do not fit
/// become the nearest that do.
/// @param ionosphere of BeiDou; absent: zeros
/// @param subframe 1 … 3
/// @param end when the subframe ends; it tells of its start
D1Words d1_subframe(const KeplerEphemeris& record, const std::optional<KlobucharCoefficients>& ionosphere, int subframe,
                    GpsTime end);

}  // namespace skyloop
