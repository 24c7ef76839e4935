/// Threads that search for paths beside the caller.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace skyloop::inline world {

/// One task at a time runs on one of a few threads while the caller does other things; the task may share parts of its
/// work among all of them. Without threads everything happens in the calling thread. Which thread does what is left to
/// chance, hence a task's parts must write to places of their own.
class SearchCrew {
public:
    /// Work on one part; `worker` numbers the thread, from 0; alone the caller is 0.
    using Part = std::function<void(std::size_t part, std::size_t worker)>;

    /// @param threads 0: the caller. Where the system grants fewer, there are fewer.
    explicit SearchCrew(int threads);
    /// Waits for the running task.
    ~SearchCrew();
    SearchCrew(const SearchCrew&) = delete;
    SearchCrew& operator=(const SearchCrew&) = delete;

    /// Begins a task; the one before must have been waited for. Without threads it is done on return.
    void start(std::function<void()> task);
    /// Waits for the end of the task; everything that it wrote may then be read. At once when there is none.
    void wait();
    /// For the running task alone: works on parts 0 … count − 1 and waits for all.
    void share(std::size_t count, const Part& part);

private:
    void work(std::size_t worker);
    void work_on_parts(std::unique_lock<std::mutex>& lock, std::size_t worker);

    std::mutex mutex_;
    std::condition_variable news_;  ///< a task, parts, or the end
    std::condition_variable done_;  ///< a task or all parts are finished
    std::function<void()> task_;
    bool waiting_ = false, running_ = false, ending_ = false;
    const Part* part_ = nullptr;
    std::size_t count_ = 0, next_ = 0, unfinished_ = 0;
    std::size_t leader_ = 0;             ///< the worker that runs the task
    std::vector<std::jthread> threads_;  ///< last: they end before what they use
};

}  // namespace skyloop::inline world
