// The wall clock is no GPS time.
#include <chrono>

#include "base/time/gps_time.hpp"

using namespace skyloop;

GpsTime control(std::chrono::nanoseconds since_epoch) { return GpsTime(since_epoch); }

#ifdef MUST_NOT_COMPILE
GpsTime bad(std::chrono::system_clock::time_point now) { return now; }
#endif
