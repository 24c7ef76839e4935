/// The processor's time of one thread: other programs do not count.
#pragma once

#include <time.h>

namespace skyloop::bench {

/// What the calling thread has spent so far, s.
inline double thread_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace skyloop::bench
