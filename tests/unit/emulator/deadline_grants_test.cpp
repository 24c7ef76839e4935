#include "run/emulator/real_time.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

namespace skyloop {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

// kB of this process that are locked (proc(5), VmLck).
long locked_kilobytes() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.rfind("VmLck:", 0) == 0) return std::stol(line.substr(6));
    return -1;
}

// A lock on all memory would stay with the other tests: each case has a process of its own, that ends 0 when `body` is
// content.
template <class Body>
void in_own_process(Body body) {
    const pid_t child = ::fork();
    if (child == 0) ::_exit(body() && !testing::Test::HasFailure() ? 0 : 1);
    int status = -1;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST(DeadlineGrants, WhatIsSaidIsTrue) {
    in_own_process([] {
        const DeadlineGrants grants = prepare_for_deadlines();
        // Under a sanitizer nothing is ever locked, and no complaint is made.
        const bool locked = locked_kilobytes() > 1000;
        EXPECT_TRUE(grants.memory_locked || !locked);
        EXPECT_EQ(grants.missing.size(),
                  (grants.priority == ThreadPriority::realtime ? 0U : 1U) + (grants.memory_locked ? 0U : 1U));
        return true;
    });
}

TEST(DeadlineGrants, ALimitThatHoldsIsNotTried) {
    in_own_process([] {
        if (::getuid() == 0 && (::setgid(65534) != 0 || ::setuid(65534) != 0)) return false;
        const rlimit small{std::size_t{64} << 10U, std::size_t{64} << 10U};
        if (::setrlimit(RLIMIT_MEMLOCK, &small) != 0) return false;
        const DeadlineGrants grants = prepare_for_deadlines();
        EXPECT_FALSE(grants.memory_locked);
        EXPECT_THAT(grants.missing, Contains(HasSubstr("memory is not locked (the limit is 64 kB): it needs "
                                                       "CAP_IPC_LOCK or an unlimited memlock")));
        // What comes later is not refused.
        void* const room =
            ::mmap(nullptr, std::size_t{1} << 20U, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
        return room != MAP_FAILED;
    });
}

TEST(DeadlineGrants, ALimitOfRtprioIsNamed) {
    in_own_process([] {
        if (::getuid() == 0 && (::setgid(65534) != 0 || ::setuid(65534) != 0)) return false;
        const rlimit none{0, 0};
        if (::setrlimit(RLIMIT_RTPRIO, &none) != 0) return false;
        const DeadlineGrants grants = prepare_for_deadlines();
        EXPECT_NE(grants.priority, ThreadPriority::realtime);
        EXPECT_THAT(grants.missing, Contains(HasSubstr("the loop is not real-time: it needs CAP_SYS_NICE")));
        return true;
    });
}

}  // namespace
}  // namespace skyloop
