/// Fixes from a log of u-blox UBX messages.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "study/analysis/fix_series.hpp"

namespace skyloop {

/// What a log of UBX messages holds; `series` has no samples where no message tells a position.
struct UbxLog {
    FixSeries series;
    std::size_t messages = 0;  ///< whole ones with a right checksum, of any kind
};

/// True when the bytes that start a UBX message stand somewhere in the text.
bool has_ubx_sync(std::string_view text);

/// A sample from each epoch (messages of one iTOW) with NAV-PVT, NAV-SOL, NAV-POSLLH or NAV-HPPOSLLH. It is a fix when
/// the flags of NAV-PVT, else of NAV-SOL, else of NAV-STATUS say so: gnssFixOK and a fix type of dead reckoning, 2D, 3D
/// or combined; a time-only fix is none. Weeks are those of NAV-TIMEGPS, NAV-SOL or the UTC date of NAV-PVT. Signal
/// strengths are those of NAV-SAT, else of NAV-SVINFO. Everything else between the messages is passed over; damaged
/// messages are counted in the warnings.
UbxLog parse_ubx_log(std::string_view text, const std::string& name);

}  // namespace skyloop
