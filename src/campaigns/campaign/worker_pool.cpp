#include "campaigns/campaign/worker_pool.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <map>

#include "detail/worker_process.hpp"

namespace skyloop {
namespace {

using PoolClock = std::chrono::steady_clock;

constexpr int pool_look_ms = 100;
constexpr std::chrono::seconds patience{2};  // with a worker that is asked to end
constexpr int most_deaths = 100;             // of workers, before any has answered

// Who does what.
class Pool {
public:
    Pool(const PoolWork& work, const std::function<Result<JobFate>(const JobOutcome&)>& told)
        : work_(work), told_(told), waiting_(work.jobs.begin(), work.jobs.end()) {}

    [[nodiscard]] bool busy() const { return !waiting_.empty() || !workers_.empty(); }
    Result<void> step() {
        if (const auto filled = fill(); !filled) return fail(filled.error());
        wait();
        for (std::size_t i = 0; i < workers_.size();)
            if (auto lives = hear(workers_[i]); !lives)
                return fail(lives.error());
            else if (*lives)
                ++i;
            else
                workers_.erase(workers_.begin() + static_cast<std::ptrdiff_t>(i));
        return {};
    }
    void end() {
        for (const WorkerProcess& worker : workers_)
            worker.ask_to_end();
        const auto last = PoolClock::now() + patience;
        const auto all_ended = [this] {
            return std::all_of(workers_.begin(), workers_.end(), [](WorkerProcess& w) { return w.has_ended(); });
        };
        while (!all_ended() && PoolClock::now() < last)
            ::usleep(10'000);
        workers_.clear();
    }

private:
    Result<void> fill() {
        while (workers_.size() < std::min(work_.processes, workers_.size() + waiting_.size())) {
            auto worker = WorkerProcess::start(work_.command);
            if (!worker) return fail(worker.error());
            if (worker->tell(work_.greeting)) give(*worker);
            workers_.push_back(std::move(*worker));
        }
        return {};
    }
    void give(WorkerProcess& worker) {
        worker.job = waiting_.front();
        waiting_.pop_front();
        worker.since = PoolClock::now();
        ++attempts_[*worker.job];
        // Where it does not listen it has died, which its other pipe tells.
        static_cast<void>(worker.tell(work_.ask(*worker.job)));
    }
    void wait() {
        std::vector<pollfd> ends;
        for (const WorkerProcess& worker : workers_)
            ends.push_back({worker.descriptor(), POLLIN, 0});
        ::poll(ends.data(), ends.size(), pool_look_ms);
    }
    // @return whether the worker goes on
    Result<bool> hear(WorkerProcess& worker) {
        const bool lives = worker.listen();
        if (worker.overdue) return end_overdue(worker, lives);
        while (auto line = worker.take_line()) {
            answered_ = true;
            if (const auto said = tell_outcome(worker, std::move(*line), {}); !said) return fail(said.error());
            if (waiting_.empty()) return false;
            if (lives) give(worker);
        }
        if (lives) {
            worker.overdue = worker.job && work_.job_limit.count() > 0 && worked(worker) > work_.job_limit;
            if (worker.overdue) worker.ask_to_end();
            return true;
        }
        const std::string death = worker.finish();
        // A run that kills its worker is tried twice, whatever the others do; where none ever answers, it is the
        // worker.
        if (!answered_ && ++deaths_ >= most_deaths)
            return fail(ErrorCode::outside, fmt::format("workers end without an answer, the last by {}", death));
        if (!worker.job) return false;
        if (const auto said = tell_outcome(worker, {}, death); !said) return fail(said.error());
        return false;
    }
    static std::chrono::duration<double> worked(const WorkerProcess& worker) { return PoolClock::now() - worker.since; }
    // What it answers to being asked to end is no result. @return whether it is waited for
    Result<bool> end_overdue(WorkerProcess& worker, bool lives) {
        if (lives && !worker.take_line() && worked(worker) < work_.job_limit + patience) return true;
        worker.finish();
        const auto said = tell_outcome(worker, {}, fmt::format("it took more than {:g} s", work_.job_limit.count()));
        if (!said) return fail(said.error());
        return false;
    }
    Result<void> tell_outcome(WorkerProcess& worker, std::string answer, const std::string& death) {
        if (!worker.job) return fail(ErrorCode::outside, "a worker answered what it was not asked");
        const std::uint64_t job = *worker.job;
        worker.job.reset();
        const std::chrono::duration<double> took = PoolClock::now() - worker.since;
        const auto fate = told_({job, attempts_[job], std::move(answer), death, took.count()});
        if (!fate) return fail(fate.error());
        if (*fate == JobFate::again)
            waiting_.push_back(job);
        else
            attempts_.erase(job);
        return {};
    }

    const PoolWork& work_;
    const std::function<Result<JobFate>(const JobOutcome&)>& told_;
    std::deque<std::uint64_t> waiting_;
    std::map<std::uint64_t, int> attempts_;
    std::vector<WorkerProcess> workers_;
    bool answered_ = false;
    int deaths_ = 0;
};

}  // namespace

Result<void> run_jobs(const PoolWork& work, const std::function<Result<JobFate>(const JobOutcome&)>& told,
                      const std::function<void()>& rest, const std::atomic<bool>& stop) {
    Pool pool(work, told);
    while (pool.busy() && !stop) {
        if (const auto stepped = pool.step(); !stepped) {
            pool.end();
            return fail(stepped.error());
        }
        rest();
    }
    pool.end();
    return {};
}

}  // namespace skyloop
