#include "base/core/threads.hpp"

#include <csignal>
#include <ctime>
#include <utility>

namespace skyloop::inline base {

std::int64_t steady_clock_ns() {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * std::int64_t{1'000'000'000} + now.tv_nsec;
}

void with_signals_held_back(const std::function<void()>& start) {
    sigset_t all;
    sigset_t before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    start();
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

JobThread::JobThread(std::size_t most) : most_(most) {
    with_signals_held_back([this] { thread_ = std::thread([this] { work(); }); });
}

JobThread::~JobThread() {
    {
        const std::scoped_lock lock(mutex_);
        ends_ = true;
    }
    handed_over_.notify_one();
    thread_.join();
}

void JobThread::run(std::function<void()> job) {
    {
        const std::scoped_lock lock(mutex_);
        waiting_.push_back(std::move(job));
        if (waiting_.size() > most_) {
            waiting_.pop_front();
            ++left_out_;
        }
    }
    handed_over_.notify_one();
}

std::size_t JobThread::left_out() const {
    const std::scoped_lock lock(mutex_);
    return left_out_;
}

void JobThread::work() {
    std::unique_lock lock(mutex_);
    for (;;) {
        handed_over_.wait(lock, [this] { return ends_ || !waiting_.empty(); });
        if (waiting_.empty()) return;
        const std::function<void()> job = std::move(waiting_.front());
        waiting_.pop_front();
        lock.unlock();
        job();
        lock.lock();
    }
}

}  // namespace skyloop::inline base
