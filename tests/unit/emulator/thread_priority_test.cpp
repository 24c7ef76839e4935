#include "run/emulator/real_time.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/resource.h>

#include <thread>

namespace skyloop {
namespace {

TEST(RaiseThreadPriority, GivesWhatItSaysToTheCallingThreadAlone) {
    int child_policy = -1;
    std::thread([&] {
        const ThreadPriority granted = raise_thread_priority();
        const int policy = sched_getscheduler(0) & ~SCHED_RESET_ON_FORK;
        EXPECT_EQ(policy, granted == ThreadPriority::realtime ? SCHED_FIFO : SCHED_OTHER);
        if (granted == ThreadPriority::raised) {
            EXPECT_LT(getpriority(PRIO_PROCESS, 0), 0);
        }
        std::thread([&] { child_policy = sched_getscheduler(0) & ~SCHED_RESET_ON_FORK; }).join();
    }).join();
    EXPECT_EQ(child_policy, SCHED_OTHER);
    EXPECT_EQ(sched_getscheduler(0), SCHED_OTHER);
}

}  // namespace
}  // namespace skyloop
