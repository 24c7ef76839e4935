// GPS time and UTC do not subtract: that takes a table of leap seconds.
#include "base/time/utc_time.hpp"

using namespace skyloop;

auto control(GpsTime a, const UtcTime& b, const LeapSeconds& leap_seconds) { return a - to_gps_time(b, leap_seconds); }

#ifdef MUST_NOT_COMPILE
auto bad(GpsTime a, const UtcTime& b) { return a - b; }
#endif
