/// Layout variants of NMEA 0183.
#pragma once

namespace skyloop {

/// Which fields the sentences have and how satellites are numbered (RECEIVER.md 5.2).
enum class NmeaVersion { v2_1, v2_3, v4_0, v4_10, v4_11 };

}  // namespace skyloop
