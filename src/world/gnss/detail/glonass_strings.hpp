/// What all strings of GLONASS have in common (ICD L1, L2 GLONASS 5.1, section 4).
#pragma once

#include <cstdint>

#include "base/core/bytes.hpp"
#include "world/gnss/broadcast_glonass.hpp"

namespace skyloop::inline world {

inline constexpr std::int64_t glonass_frame_s = 30;

/// Seconds of GLONASS time, UTC + 3 h, since 1980-01-06 00:00 of its own.
std::int64_t glonass_seconds(GpsTime time, const LeapSeconds& leap_seconds);

/// The number 1 … 5 of the frame of an instant of GLONASS time.
int glonass_frame(std::int64_t seconds);

/// Number and check bits around the bits 80 to 9 of a string.
GlonassWords whole_glonass_string(int string, const BitWriter& content, GpsTime end, const LeapSeconds& leap_seconds);

}  // namespace skyloop::inline world
