/// Processes that do the runs of a campaign, so that a crash ends one run alone.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"

namespace skyloop::inline campaigns {

/// What is to be done.
struct PoolWork {
    std::vector<std::string> command;  ///< of a worker: program and arguments; it reads jobs, a line each, and answers
                                       ///< each with a line
    std::string greeting;              ///< the first line that each is told; not answered
    std::size_t processes = 1;
    std::chrono::duration<double> job_limit{0};       ///< of each, by the host's clock; 0: none
    std::vector<std::uint64_t> jobs{};                ///< in their order
    std::function<std::string(std::uint64_t)> ask{};  ///< the line of a job, without its end
};

/// How a job went.
struct JobOutcome {
    std::uint64_t job = 0;
    int attempt = 1;
    std::string answer;  ///< the worker's line; empty: the worker ended before
    std::string death;   ///< how it ended: "signal 9", "exit code 1", "it took more than 60 s"
    double seconds = 0;  ///< by the host's clock
};

/// What becomes of it.
enum class JobFate { done, again, given_up };

/// Runs all jobs. `told` is called for each outcome, by the calling thread; `again` puts the job behind the others.
/// A worker that is at a job for longer than its limit is asked to end, and killed when it does not within two seconds.
/// `rest` is called some times a second. Ends when all are done or given up, or when `stop` is true: workers are then
/// asked to end (SIGTERM), and killed when they do not within two seconds. Fails with `outside` when no worker lives
/// long enough to answer, or as `told` does; no worker is left then.
Result<void> run_jobs(const PoolWork& work, const std::function<Result<JobFate>(const JobOutcome&)>& told,
                      const std::function<void()>& rest, const std::atomic<bool>& stop);

}  // namespace skyloop::inline campaigns
