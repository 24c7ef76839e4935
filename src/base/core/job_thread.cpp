#include "base/core/job_thread.hpp"

#include <utility>

#include "base/core/signals_held_back.hpp"

namespace skyloop {

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

}  // namespace skyloop
