#include "campaigns/engines/slurm_job.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <string_view>
#include <thread>

#include "base/core/files.hpp"
#include "base/core/number_text.hpp"
#include "base/core/process.hpp"
#include "campaigns/engines/engine_files.hpp"

namespace skyloop::inline campaigns {
namespace {

using FollowClock = std::chrono::steady_clock;  // a queue lives by the host's time

constexpr int exit_bad_campaign = 2, exit_interrupted = 75;

// Without the end of the last line.
std::string without_end(std::string text) {
    while (!text.empty() && text.back() == '\n')
        text.pop_back();
    return text;
}

std::string one_line(std::string text) {
    text = without_end(std::move(text));
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

std::string why(const ProcessOutcome& outcome) {
    if (outcome.timed_out) return "no answer in time";
    if (outcome.exit_code && outcome.errors.empty()) return fmt::format("exit code {}", *outcome.exit_code);
    return one_line(outcome.errors);
}

bool is_number(std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

// sbatch --parsable prints the job's number and, where there are many clusters, ";CLUSTER".
Result<std::string> submit(const std::vector<std::string>& options, const std::filesystem::path& script) {
    ProcessRequest request;
    request.command = {"sbatch", "--parsable"};
    request.command.insert(request.command.end(), options.begin(), options.end());
    request.command.push_back(script.string());
    request.timeout = Seconds(120);
    const auto outcome = run_process(request);
    if (!outcome) return fail(ErrorCode::outside, outcome.error().message + "; expected the tools of a Slurm in PATH");
    const std::string number = outcome->output.substr(0, outcome->output.find_first_of(";\n"));
    if (outcome->exit_code != 0 || !is_number(number))
        return fail(ErrorCode::outside, fmt::format("sbatch {}: {}", script.string(), why(*outcome)));
    return number;
}

// "3-5,9" of 3 4 5 9, which are in order.
std::string ranges_of(const std::vector<std::size_t>& numbers) {
    std::string out;
    for (std::size_t i = 0; i < numbers.size();) {
        std::size_t last = i;
        while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1)
            ++last;
        out += (out.empty() ? "" : ",") +
               (last == i ? fmt::format("{}", numbers[i]) : fmt::format("{}-{}", numbers[i], numbers[last]));
        i = last + 1;
    }
    return out;
}

// How many tasks are in which state, as squeue tells for some minutes even of those that have ended.
struct QueueState {
    std::size_t running = 0, waiting = 0, cancelled = 0;
    [[nodiscard]] bool over() const { return running + waiting == 0; }
};

void count_state(std::string_view state, QueueState& queue) {
    constexpr std::array<std::string_view, 10> ended{"BOOT_FAIL",     "COMPLETED", "DEADLINE",      "FAILED",
                                                     "LAUNCH_FAILED", "NODE_FAIL", "OUT_OF_MEMORY", "PREEMPTED",
                                                     "REVOKED",       "TIMEOUT"};
    if (state.empty() || std::find(ended.begin(), ended.end(), state) != ended.end()) return;
    if (state == "CANCELLED")
        ++queue.cancelled;
    else if (state == "RUNNING" || state == "COMPLETING")
        ++queue.running;
    else
        ++queue.waiting;
}

Result<QueueState> look_at_queue(const SlurmJob& job) {
    QueueState queue;
    ProcessRequest request;
    request.command = {"squeue",      "--noheader",
                       "--array",     "--states=all",
                       "--format=%T", "--jobs=" + job.shards + (job.gather.empty() ? "" : "," + job.gather)};
    request.timeout = Seconds(60);
    request.line = [&](std::string_view line) {
        count_state(line.substr(0, line.find(' ')), queue);
        return false;
    };
    const auto outcome = run_process(request);
    if (!outcome) return fail(outcome.error());
    // Jobs that ended long ago are forgotten, and then asking for them is an error.
    if (outcome->exit_code != 0 && outcome->errors.find("Invalid job id") == std::string::npos)
        return fail(ErrorCode::outside, fmt::format("squeue: {}", why(*outcome)));
    return queue;
}

std::filesystem::path exit_file(const EngineTask& task, std::size_t shard) {
    return slurm_folder(task) / "exit" / std::to_string(shard);
}

class Follower {
public:
    Follower(const EngineTask& task, SlurmJob job, const FollowOptions& options)
        : task_(task), job_(std::move(job)), options_(options), results_(task.out) {
        task_.shards = job_.count;
    }
    Result<int> follow();

private:
    struct Outcome {
        std::vector<std::size_t> bad, unfinished;
    };
    bool pause(Seconds time) const;
    Result<bool> wait_for_queue();
    void tell(const QueueState& queue);
    Outcome outcome_of_shards() const;
    Outcome patient_outcome() const;
    std::optional<int> verdict_on(const Outcome& outcome, std::size_t submission) const;
    int gathered() const;

    EngineTask task_;
    SlurmJob job_;
    const FollowOptions& options_;
    ResultCounter results_;
    std::string told_;
    bool cancelled_ = false;
};

// False when somebody wants it to stop.
bool Follower::pause(Seconds time) const {
    const auto end = FollowClock::now() + std::chrono::duration<double>(time.value());
    while (!options_.stopped() && FollowClock::now() < end)
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return !options_.stopped();
}

void Follower::tell(const QueueState& queue) {
    const std::size_t results = results_.look();
    const std::string of_runs = options_.runs > 0 ? fmt::format(" of {}", options_.runs) : std::string();
    std::string line = fmt::format("job {}: {}{} results, {} tasks running, {} waiting", job_.shards, results, of_runs,
                                   queue.running, queue.waiting);
    if (line == told_) return;
    options_.say(line);
    told_ = std::move(line);
}

// False when it was stopped.
Result<bool> Follower::wait_for_queue() {
    auto answered = FollowClock::now();
    bool silent = false;
    for (;;) {
        const auto queue = look_at_queue(job_);
        const auto now = FollowClock::now();
        if (queue) {
            answered = now;
            silent = false;
            tell(*queue);
            cancelled_ = queue->cancelled > 0;
            if (queue->over()) return true;
        } else if (std::chrono::duration<double>(now - answered).count() > options_.squeue_patience.value()) {
            return fail(queue.error());
        } else if (!silent) {
            silent = true;
            options_.say(fmt::format("{}; asking again", queue.error().message));
        }
        if (!pause(options_.between_looks)) return false;
    }
}

Follower::Outcome Follower::outcome_of_shards() const {
    Outcome outcome;
    for (std::size_t shard = 0; shard < task_.shards; ++shard) {
        const auto code = whole_number_of(exit_file(task_, shard));
        if (code == exit_bad_campaign)
            outcome.bad.push_back(shard);
        else if (code != 0 && code != 3)
            outcome.unfinished.push_back(shard);
    }
    return outcome;
}

// A shared file system may show a file later than the queue shows the end of who wrote it.
Follower::Outcome Follower::patient_outcome() const {
    const auto end = FollowClock::now() + std::chrono::duration<double>(options_.file_patience.value());
    Outcome outcome = outcome_of_shards();
    while (!outcome.unfinished.empty() && FollowClock::now() < end && pause(Seconds(0.2)))
        outcome = outcome_of_shards();
    return outcome;
}

// Nothing: the unfinished ones are worth another submission.
std::optional<int> Follower::verdict_on(const Outcome& outcome, std::size_t submission) const {
    const auto log_of = [&](std::size_t shard) {
        return (slurm_folder(task_) / "log" / fmt::format("{}.txt", shard)).string();
    };
    if (!outcome.bad.empty()) {
        options_.say(fmt::format("shard {} says that the campaign cannot be; see {}", outcome.bad.front(),
                                 log_of(outcome.bad.front())));
        return exit_bad_campaign;
    }
    if (outcome.unfinished.empty()) return gathered();
    if (cancelled_) {
        options_.say(fmt::format("tasks of job {} were cancelled, so {} shards are unfinished; submit again to go on",
                                 job_.shards, outcome.unfinished.size()));
        return exit_interrupted;
    }
    if (submission < options_.submissions) return std::nullopt;
    options_.say(fmt::format("{} shards are unfinished after {} submissions ({}); see {}", outcome.unfinished.size(),
                             submission, ranges_of(outcome.unfinished), log_of(outcome.unfinished.front())));
    return 1;
}

int Follower::gathered() const {
    const auto log = slurm_folder(task_) / "log" / "gather.txt";
    if (const auto text = read_text_file(log); text && !text->empty()) options_.say(without_end(*text));
    const auto code = whole_number_of(slurm_folder(task_) / "exit" / "gather");
    if (!code) options_.say(fmt::format("all shards are done, but their gathering did not end; see {}", log.string()));
    return code.value_or(1);
}

Result<int> Follower::follow() {
    for (std::size_t submission = 1;; ++submission) {
        const auto over = wait_for_queue();
        if (!over) return fail(over.error());
        if (!*over) {
            options_.say(fmt::format("no longer followed; job {} goes on (--follow takes it up again)", job_.shards));
            return exit_interrupted;
        }
        const Outcome outcome = patient_outcome();
        if (const auto code = verdict_on(outcome, submission)) return *code;
        const std::string which = ranges_of(outcome.unfinished);
        options_.say(fmt::format("{} shards were lost ({}): submitted again", outcome.unfinished.size(), which));
        auto job = submit_slurm(task_, outcome.unfinished);
        if (!job) return fail(job.error());
        job_ = *job;
    }
}

}  // namespace

Result<void> write_slurm_files(const EngineTask& task, const SlurmScripts& scripts) {
    const auto folder = slurm_folder(task);
    // Slurm makes no folder for a task's output, and drops the output when there is none.
    if (const auto made = make_folder(folder / "log"); !made) return fail(made.error());
    if (auto written = write_engine_file(folder / "campaign.sbatch", scripts.shards); !written) return written;
    return write_engine_file(folder / "gather.sbatch", scripts.gather);
}

Result<void> check_slurm_queue(const EngineTask& task) {
    const auto last = submitted_slurm(task);
    if (!last) return {};
    const auto queue = look_at_queue(*last);
    if (!queue) return fail(queue.error());
    if (queue->over()) return {};
    return fail(ErrorCode::outside,
                fmt::format("{}: job {} of this campaign is still in the queue; follow it (--follow), or scancel {} {}",
                            task.out.string(), last->shards, last->shards, last->gather));
}

Result<SlurmJob> submit_slurm(const EngineTask& task, const std::vector<std::size_t>& only) {
    if (const auto over = check_slurm_queue(task); !over) return fail(over.error());
    std::error_code ignored;
    std::filesystem::remove(slurm_folder(task) / "exit" / "gather", ignored);
    for (std::size_t i = 0; i < (only.empty() ? task.shards : only.size()); ++i)
        std::filesystem::remove(exit_file(task, only.empty() ? i : only[i]), ignored);
    std::vector<std::string> options;
    if (!only.empty()) options.push_back("--array=" + ranges_of(only));
    const auto shards = submit(options, slurm_folder(task) / "campaign.sbatch");
    if (!shards) return fail(shards.error());
    // Whatever became of the shards: what is missing is counted by the gathering.
    const auto gather = submit({"--dependency=afterany:" + *shards}, slurm_folder(task) / "gather.sbatch");
    const SlurmJob job{*shards, gather ? *gather : std::string(), task.shards};
    const auto kept =
        write_engine_file(slurm_folder(task) / "jobs", fmt::format("{} {} {}\n", job.shards, task.shards, job.gather));
    if (!gather) return fail(gather.error());
    if (!kept) return fail(kept.error());
    return job;
}

std::optional<SlurmJob> submitted_slurm(const EngineTask& task) {
    const std::string line = first_line_of(slurm_folder(task) / "jobs");
    const std::size_t first = line.find(' '), second = line.find(' ', first == std::string::npos ? first : first + 1);
    if (second == std::string::npos) return std::nullopt;
    SlurmJob job{line.substr(0, first), line.substr(second + 1), 0};
    job.count =
        number_in<decltype(job.count)>(std::string_view(line).substr(first + 1, second - first - 1)).value_or(0);
    const bool counted = job.count >= 1 && job.count <= max_shards;
    if (!counted || !is_number(job.shards) || !(job.gather.empty() || is_number(job.gather))) return std::nullopt;
    return job;
}

Result<int> follow_slurm(const EngineTask& task, SlurmJob job, const FollowOptions& options) {
    return Follower(task, std::move(job), options).follow();
}

}  // namespace skyloop::inline campaigns
