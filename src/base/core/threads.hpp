/// A clock that never jumps.
/// Threads that take no signals.
/// Small jobs on a thread of their own.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace skyloop::inline base {

/// Of the clock that deadlines are slept to (CLOCK_MONOTONIC), ns.
std::int64_t steady_clock_ns();

/// Runs `start` while the calling thread takes no signals; the threads that it starts never will. A signal that ends
/// the program must interrupt the thread that waits for it, not a helper.
void with_signals_held_back(const std::function<void()>& start);

/// Runs jobs one after the other, in their order. Who hands one over never waits for it: a terminal that is held, or a
/// pipe that nobody reads, must not hold up a loop with deadlines. The thread takes no signals.
class JobThread {
public:
    /// @param most jobs that may wait; of more, the oldest is left out
    explicit JobThread(std::size_t most);
    /// Runs what still waits, and ends.
    ~JobThread();
    JobThread(const JobThread&) = delete;
    JobThread& operator=(const JobThread&) = delete;

    void run(std::function<void()> job);
    /// Jobs that were left out.
    [[nodiscard]] std::size_t left_out() const;

private:
    void work();

    const std::size_t most_;
    mutable std::mutex mutex_;
    std::condition_variable handed_over_;
    std::deque<std::function<void()>> waiting_;
    std::size_t left_out_ = 0;
    bool ends_ = false;
    std::thread thread_;  // last: it uses all of them
};

}  // namespace skyloop::inline base
