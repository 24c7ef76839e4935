/// How the operating system treats the thread that keeps simulated time.
/// What the operating system gives a loop that has deadlines to keep.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace skyloop::inline run {

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

/// What has been granted, and how to be given the rest.
struct DeadlineGrants {
    ThreadPriority priority = ThreadPriority::normal;
    bool memory_locked = false;             ///< no page of the process is ever fetched again (mlockall)
    std::uint64_t timer_slack_ns = 0;       ///< by which the kernel may wake the loop late to save power
    std::vector<std::string> missing = {};  ///< a sentence for each thing that was refused: why, and what gives it
};

/// Asks for all that helps the calling thread to keep time: its priority (raise_thread_priority()), the process's
/// memory locked, now and in future, and the first half megabyte of its stack touched. Memory is locked only where no
/// limit (RLIMIT_MEMLOCK) could refuse a later allocation, which would end the program in the middle of a run.
DeadlineGrants prepare_for_deadlines();

}  // namespace skyloop::inline run
