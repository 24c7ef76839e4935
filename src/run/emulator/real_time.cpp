#include "run/emulator/real_time.hpp"

#include <fmt/format.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

namespace skyloop::inline run {
namespace {

// Above what has no deadline, below the kernel's own interrupt threads (50).
constexpr int fifo_priority = 10;
constexpr int raised_nice = -11;
constexpr int background_nice = 5;

}  // namespace

ThreadPriority raise_thread_priority() {
    sched_param parameters{};
    parameters.sched_priority = fifo_priority;
    // 0 is the calling thread, for both calls.
    if (sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &parameters) == 0) return ThreadPriority::realtime;
    parameters.sched_priority = 0;
    if (sched_setscheduler(0, SCHED_OTHER | SCHED_RESET_ON_FORK, &parameters) == 0 &&
        setpriority(PRIO_PROCESS, 0, raised_nice) == 0)
        return ThreadPriority::raised;
    return ThreadPriority::normal;
}

std::thread background_thread(std::function<void()> work) {
    sigset_t all{}, before{};
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);  // what a new thread inherits
    std::thread thread([work = std::move(work)] {
        setpriority(PRIO_PROCESS, 0, background_nice);  // of this thread alone, on Linux
        work();
    });
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    return thread;
}

std::string_view to_string(ThreadPriority priority) {
    constexpr std::array<std::string_view, 3> names{"real-time", "raised", "normal"};
    return names[static_cast<std::size_t>(priority)];
}

namespace {

constexpr std::size_t stack_in_use = std::size_t{512} << 10U;  // far more than the loop's deepest call
constexpr std::size_t page_bytes = 4096;                       // the smallest there is

// Whether a lock of one page more than the limit is granted: to those with CAP_IPC_LOCK it is. Locked on fault, the
// pages cost nothing.
bool limit_does_not_hold(std::size_t limit) {
    const std::size_t size = limit / page_bytes * page_bytes + page_bytes;
    void* const room = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (room == MAP_FAILED) return false;
    const bool locked = ::mlock2(room, size, MLOCK_ONFAULT) == 0;
    ::munmap(room, size);
    return locked;
}

// The limit, bytes, that would one day refuse a lock; 0: none would.
std::size_t limit_on_locked_memory() {
    rlimit limit{};
    if (::getrlimit(RLIMIT_MEMLOCK, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return 0;
    if (limit.rlim_max == RLIM_INFINITY) {
        const rlimit lifted{RLIM_INFINITY, RLIM_INFINITY};
        if (::setrlimit(RLIMIT_MEMLOCK, &lifted) == 0) return 0;
    }
    return limit_does_not_hold(limit.rlim_cur) ? 0 : std::max<std::size_t>(limit.rlim_cur, 1);
}

void touch_stack() {
    std::array<volatile unsigned char, stack_in_use> room;
    for (std::size_t at = 0; at < room.size(); at += page_bytes)
        room[at] = 0;
}

std::string lock_refusal(const std::string& reason) {
    return fmt::format(
        "memory is not locked ({}): it needs CAP_IPC_LOCK or an unlimited memlock; `ulimit -l unlimited`, `USER - "
        "memlock unlimited` in /etc/security/limits.conf or LimitMEMLOCK=infinity of systemd gives it",
        reason);
}

}  // namespace

DeadlineGrants prepare_for_deadlines() {
    DeadlineGrants grants;
    grants.priority = raise_thread_priority();
    if (grants.priority != ThreadPriority::realtime)
        grants.missing.emplace_back(
            "the loop is not real-time: it needs CAP_SYS_NICE or a limit on rtprio of 10 or more; `ulimit -r 10`, "
            "`USER "
            "- rtprio 10` in /etc/security/limits.conf or LimitRTPRIO=10 of systemd gives it");
    if (const std::size_t limit = limit_on_locked_memory(); limit > 0)
        grants.missing.push_back(lock_refusal(fmt::format("the limit is {} kB", limit / 1024)));
    else if (::mlockall(MCL_CURRENT | MCL_FUTURE) == 0)
        grants.memory_locked = true;
    else
        grants.missing.push_back(lock_refusal(std::strerror(errno)));
    touch_stack();
    if (const int slack = ::prctl(PR_GET_TIMERSLACK); slack > 0) grants.timer_slack_ns = static_cast<unsigned>(slack);
    return grants;
}

}  // namespace skyloop::inline run
