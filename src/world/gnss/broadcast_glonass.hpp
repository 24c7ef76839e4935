/// GLONASS navigation strings (ICD L1, L2 GLONASS 5.1, section 4).
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "base/time/utc_time.hpp"
#include "world/gnss/ephemeris.hpp"

namespace skyloop::inline world {

/// The 85 bits of a string, bit 85 in the highest bit of the first word; in the last word the number of the superframe
/// since the start of GLONASS time's week, from 1 on, times 65536, plus that of the frame, 1 … 5 [seen in captures].
using GlonassWords = std::array<std::uint32_t, 4>;

/// The string that ends with an instant.
/// @return 1 … 15; nothing when no string ends then: they are of 2 s from the start of the day of UTC + 3 h on
std::optional<int> glonass_string_ending(GpsTime end, const LeapSeconds& leap_seconds);

/// One of the strings 1 to 5 (tables 4.5 and 4.9): state vector, clock, time. Values that do not fit become the
/// nearest that do. @param end when it ends
GlonassWords glonass_string(const GlonassEphemeris& record, int string, GpsTime end, const LeapSeconds& leap_seconds);

}  // namespace skyloop::inline world
