/// A clock that never jumps.
#pragma once

#include <cstdint>

namespace skyloop {

/// Of the clock that deadlines are slept to (CLOCK_MONOTONIC), ns.
std::int64_t steady_clock_ns();

}  // namespace skyloop
