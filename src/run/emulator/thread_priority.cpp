#include "run/emulator/thread_priority.hpp"

#include <sched.h>
#include <sys/resource.h>

#include <csignal>
#include <utility>

namespace skyloop {
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
    switch (priority) {
        case ThreadPriority::realtime:
            return "real-time";
        case ThreadPriority::raised:
            return "raised";
        case ThreadPriority::normal:
            break;
    }
    return "normal";
}

}  // namespace skyloop
