/// What the operating system gives a loop that has deadlines to keep.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "run/emulator/thread_priority.hpp"

namespace skyloop {

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

}  // namespace skyloop
