/// How the operating system treats the thread that keeps simulated time.
#pragma once

#include <functional>
#include <string_view>
#include <thread>

namespace skyloop {

enum class ThreadPriority {
    realtime,  ///< SCHED_FIFO: runs as soon as it wakes
    raised,    ///< a better nice value: still shares, with a larger share
    normal,    ///< what everyone has
};

/// Asks for the best that this process may have, for the calling thread alone: threads and processes that it starts get
/// the normal one. Bytes leave within a millisecond then, whatever else the machine does; without, two busy programs
/// beside on two cores delay them by 4 ms at the 99th percentile.
ThreadPriority raise_thread_priority();

/// "real-time", "raised" or "normal".
std::string_view to_string(ThreadPriority priority);

/// A thread beside the loop's, of which the loop feels as little as can be: it gives way to others, and the signals of
/// the process go to those who wait for them.
std::thread background_thread(std::function<void()> work);

}  // namespace skyloop
