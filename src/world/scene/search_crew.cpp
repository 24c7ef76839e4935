#include "detail/search_crew.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

#include "base/core/threads.hpp"

namespace skyloop::inline world {
SearchCrew::SearchCrew(int threads) {
    with_signals_held_back([this, threads] {
        try {
            for (std::size_t i = 0; i < static_cast<std::size_t>(std::max(0, threads)); ++i)
                threads_.emplace_back([this, i] { work(i); });
        } catch (const std::system_error&) {
            // Those that there are find the same paths.
        }
    });
}

SearchCrew::~SearchCrew() {
    wait();
    {
        const std::lock_guard lock(mutex_);
        ending_ = true;
    }
    news_.notify_all();
}

void SearchCrew::start(std::function<void()> task) {
    if (threads_.empty()) {
        task();
        return;
    }
    {
        const std::lock_guard lock(mutex_);
        task_ = std::move(task);
        waiting_ = true;
        running_ = true;
    }
    news_.notify_all();
}

void SearchCrew::wait() {
    std::unique_lock lock(mutex_);
    done_.wait(lock, [this] { return !running_; });
}

void SearchCrew::share(std::size_t count, const Part& part) {
    if (threads_.size() < 2) {
        for (std::size_t i = 0; i < count; ++i)
            part(i, 0);
        return;
    }
    std::unique_lock lock(mutex_);
    part_ = &part;
    count_ = unfinished_ = count;
    next_ = 0;
    news_.notify_all();
    work_on_parts(lock, leader_);
    done_.wait(lock, [this] { return unfinished_ == 0; });
    part_ = nullptr;
    count_ = next_ = 0;
}

void SearchCrew::work_on_parts(std::unique_lock<std::mutex>& lock, std::size_t worker) {
    while (next_ < count_) {
        const std::size_t mine = next_++;
        const Part& part = *part_;
        lock.unlock();
        part(mine, worker);
        lock.lock();
        if (--unfinished_ == 0) done_.notify_all();
    }
}

void SearchCrew::work(std::size_t worker) {
    std::unique_lock lock(mutex_);
    while (true) {
        news_.wait(lock, [this] { return ending_ || waiting_ || next_ < count_; });
        if (ending_) return;
        work_on_parts(lock, worker);
        if (!waiting_) continue;
        waiting_ = false;
        leader_ = worker;
        lock.unlock();
        task_();
        lock.lock();
        running_ = false;
        done_.notify_all();
    }
}

}  // namespace skyloop::inline world
