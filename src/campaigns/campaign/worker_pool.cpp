// The processes that run a campaign's runs: one of them, and the pool.
#include "campaigns/campaign/worker_pool.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/core/file_descriptor.hpp"
#include "base/core/result.hpp"

namespace skyloop::inline campaigns {

/// A program with a socket at its standard input and a pipe from its standard output, in a process group of its own, so
/// that a terminal's Ctrl-C reaches whoever leads it alone. State: the process.
class WorkerProcess {
public:
    static Result<WorkerProcess> start(const std::vector<std::string>& command);
    WorkerProcess(WorkerProcess&& other) noexcept;
    WorkerProcess& operator=(WorkerProcess&& other) noexcept;
    /// Kills it and waits for its end.
    ~WorkerProcess();

    /// False: it does not listen any more.
    [[nodiscard]] bool tell(std::string_view line) const;
    /// Reads what has come; false: it has ended.
    [[nodiscard]] bool listen();
    /// The next whole line, without its end.
    [[nodiscard]] std::optional<std::string> take_line();
    [[nodiscard]] int descriptor() const { return from_.value(); }
    void ask_to_end() const;
    /// Kills it where it still lives. @return "signal 9", "exit code 1"
    std::string finish();
    /// Whether it has ended by itself; does not wait.
    [[nodiscard]] bool has_ended();

    std::optional<std::uint64_t> job{};  ///< that it is at
    std::chrono::steady_clock::time_point since{};
    bool overdue = false;  ///< it was asked to end, having been at it for too long

private:
    WorkerProcess() = default;

    pid_t process_ = -1;
    FileDescriptor to_, from_;
    std::string heard_;
    int status_ = 0;
};

namespace {

// Standard input and output are the pipes' ends, signals as a program expects them.
int spawn_worker(pid_t& process, const std::vector<std::string>& command, int input, int output) {
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawnattr_init(&attributes);
    ::posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
    ::posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
    sigset_t none, restored;
    sigemptyset(&none);
    sigemptyset(&restored);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE})
        sigaddset(&restored, signal);
    ::posix_spawnattr_setsigmask(&attributes, &none);
    ::posix_spawnattr_setsigdefault(&attributes, &restored);
    ::posix_spawnattr_setpgroup(&attributes, 0);
    ::posix_spawnattr_setflags(
        &attributes, static_cast<short>(POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF));
    std::vector<char*> arguments;
    for (const std::string& argument : command)
        arguments.push_back(const_cast<char*>(argument.c_str()));
    arguments.push_back(nullptr);
    const int failed = ::posix_spawn(&process, arguments[0], &actions, &attributes, arguments.data(), ::environ);
    ::posix_spawnattr_destroy(&attributes);
    ::posix_spawn_file_actions_destroy(&actions);
    return failed;
}

}  // namespace

Result<WorkerProcess> WorkerProcess::start(const std::vector<std::string>& command) {
    const auto refused = [] {
        return fail(ErrorCode::outside, fmt::format("a worker cannot be started: {}", std::strerror(errno)));
    };
    std::array<int, 2> ends{-1, -1};
    WorkerProcess worker;
    // To a socket one may write without SIGPIPE when nobody listens any more.
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) return refused();
    const FileDescriptor input(ends[0]);
    worker.to_ = FileDescriptor(ends[1]);
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) return refused();
    worker.from_ = FileDescriptor(ends[0]);
    const FileDescriptor output(ends[1]);
    const int failed = spawn_worker(worker.process_, command, input.value(), output.value());
    ::fcntl(worker.from_.value(), F_SETFL, O_NONBLOCK);
    if (failed == 0) return worker;
    worker.process_ = -1;
    return fail(ErrorCode::outside,
                fmt::format("{}: a worker cannot be started: {}", command.front(), std::strerror(failed)));
}

WorkerProcess::WorkerProcess(WorkerProcess&& other) noexcept { *this = std::move(other); }

WorkerProcess& WorkerProcess::operator=(WorkerProcess&& other) noexcept {
    std::swap(process_, other.process_);
    std::swap(to_, other.to_);
    std::swap(from_, other.from_);
    std::swap(heard_, other.heard_);
    std::swap(job, other.job);
    std::swap(since, other.since);
    std::swap(overdue, other.overdue);
    std::swap(status_, other.status_);
    return *this;
}

WorkerProcess::~WorkerProcess() { finish(); }

bool WorkerProcess::tell(std::string_view line) const {
    std::string text(line);
    text += '\n';
    for (std::string_view rest = text; !rest.empty();) {
        const ssize_t count = ::send(to_.value(), rest.data(), rest.size(), MSG_NOSIGNAL);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return false;
        rest.remove_prefix(static_cast<std::size_t>(count));
    }
    return true;
}

bool WorkerProcess::listen() {
    std::array<char, 65536> piece{};
    for (;;) {
        const ssize_t count = ::read(from_.value(), piece.data(), piece.size());
        if (count > 0) heard_.append(piece.data(), static_cast<std::size_t>(count));
        if (count == 0) return false;
        if (count < 0 && errno != EINTR) return errno == EAGAIN;
    }
}

std::optional<std::string> WorkerProcess::take_line() {
    const std::size_t end = heard_.find('\n');
    if (end == std::string::npos) return std::nullopt;
    std::string line = heard_.substr(0, end);
    heard_.erase(0, end + 1);
    return line;
}

void WorkerProcess::ask_to_end() const {
    if (process_ > 0) ::kill(process_, SIGTERM);
}

bool WorkerProcess::has_ended() {
    if (process_ <= 0) return true;
    if (::waitpid(process_, &status_, WNOHANG) != process_) return false;
    process_ = -1;
    return true;
}

std::string WorkerProcess::finish() {
    to_ = FileDescriptor();
    from_ = FileDescriptor();
    if (process_ > 0) {
        // One that ends by itself has closed its output a moment before.
        for (int i = 0; i < 20 && !has_ended(); ++i)
            ::usleep(1000);
        if (process_ > 0) {
            ::kill(process_, SIGKILL);
            while (::waitpid(process_, &status_, 0) < 0 && errno == EINTR) {
            }
            process_ = -1;
        }
    }
    return WIFSIGNALED(status_) ? fmt::format("signal {}", WTERMSIG(status_))
                                : fmt::format("exit code {}", WEXITSTATUS(status_));
}

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

}  // namespace skyloop::inline campaigns
