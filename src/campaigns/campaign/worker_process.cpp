#include "detail/worker_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

namespace skyloop {
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
    std::array<int, 2> in{-1, -1}, out{-1, -1};
    // To a socket one may write without SIGPIPE when nobody listens any more.
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, in.data()) != 0 || ::pipe2(out.data(), O_CLOEXEC) != 0) {
        const int why = errno;
        for (const int end : {in[0], in[1]})
            if (end >= 0) ::close(end);
        return fail(ErrorCode::outside, fmt::format("a worker cannot be started: {}", std::strerror(why)));
    }
    WorkerProcess worker;
    worker.to_ = in[1];
    worker.from_ = out[0];
    const int failed = spawn_worker(worker.process_, command, in[0], out[1]);
    ::close(in[0]);
    ::close(out[1]);
    ::fcntl(worker.from_, F_SETFL, O_NONBLOCK);
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

void WorkerProcess::close_pipes() {
    for (int* end : {&to_, &from_}) {
        if (*end >= 0) ::close(*end);
        *end = -1;
    }
}

bool WorkerProcess::tell(std::string_view line) const {
    std::string text(line);
    text += '\n';
    for (std::string_view rest = text; !rest.empty();) {
        const ssize_t count = ::send(to_, rest.data(), rest.size(), MSG_NOSIGNAL);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return false;
        rest.remove_prefix(static_cast<std::size_t>(count));
    }
    return true;
}

bool WorkerProcess::listen() {
    std::array<char, 65536> piece{};
    for (;;) {
        const ssize_t count = ::read(from_, piece.data(), piece.size());
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
    close_pipes();
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

}  // namespace skyloop
