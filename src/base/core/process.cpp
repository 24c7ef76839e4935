#include "base/core/process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>

#include "base/core/file_descriptor.hpp"

namespace skyloop::inline base {
namespace {

using ProcessClock = std::chrono::steady_clock;  // the program lives by the host's time

constexpr int look_every_ms = 20;
constexpr std::size_t longest_line = 65536;

struct Pipe {
    FileDescriptor read, write;
    Pipe() {
        std::array<int, 2> ends{};
        if (::pipe2(ends.data(), O_CLOEXEC) != 0) return;
        read = FileDescriptor(ends[0]);
        write = FileDescriptor(ends[1]);
    }
};

std::vector<std::string> environment_with(const std::vector<std::string>& added) {
    std::vector<std::string> all;
    const auto name_of = [](std::string_view entry) { return entry.substr(0, entry.find('=')); };
    const auto put = [&](std::string_view entry) {
        for (std::string& known : all)
            if (name_of(known) == name_of(entry)) {
                known = entry;
                return;
            }
        all.emplace_back(entry);
    };
    for (char** entry = ::environ; entry != nullptr && *entry != nullptr; ++entry)
        all.emplace_back(*entry);
    for (const std::string& entry : added)
        put(entry);
    return all;
}

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
    std::vector<char*> pointers;
    for (std::string& text : texts)
        pointers.push_back(text.data());
    pointers.push_back(nullptr);
    return pointers;
}

// Started, its outputs being read, ended at last with all that it started.
class RunningProcess {
public:
    explicit RunningProcess(const ProcessRequest& request) : request_(request) {}
    ~RunningProcess() { end_group(); }
    RunningProcess(const RunningProcess&) = delete;
    RunningProcess& operator=(const RunningProcess&) = delete;

    Result<void> start();
    ProcessOutcome wait();

private:
    int spawn(std::vector<char*>& arguments, std::vector<char*>& environment);
    bool is_over();
    void read_outputs(int patience_ms);
    bool read_some(Pipe& pipe, std::string& kept, bool lines);
    void take_lines(std::string_view bytes);
    void take_line();
    void end_group();

    const ProcessRequest& request_;
    Pipe output_, errors_;
    pid_t child_ = -1;
    std::string line_;
    ProcessOutcome outcome_;
};

int RunningProcess::spawn(std::vector<char*>& arguments, std::vector<char*>& environment) {
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawnattr_init(&attributes);
    ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_adddup2(&actions, output_.write.value(), STDOUT_FILENO);
    ::posix_spawn_file_actions_adddup2(&actions, errors_.write.value(), STDERR_FILENO);
    sigset_t none, standard;
    ::sigemptyset(&none);
    ::sigemptyset(&standard);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGCHLD, SIGQUIT})
        ::sigaddset(&standard, signal);
    ::posix_spawnattr_setsigmask(&attributes, &none);
    ::posix_spawnattr_setsigdefault(&attributes, &standard);
    ::posix_spawnattr_setpgroup(&attributes, 0);
    ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    const int error =
        ::posix_spawnp(&child_, arguments[0], &actions, &attributes, arguments.data(), environment.data());
    ::posix_spawnattr_destroy(&attributes);
    ::posix_spawn_file_actions_destroy(&actions);
    if (error != 0) child_ = -1;
    return error;
}

Result<void> RunningProcess::start() {
    if (request_.command.empty() || request_.command.front().empty())
        return fail(ErrorCode::outside, "no program was named; expected a command");
    if (!output_.read.open() || !errors_.read.open())
        return fail(ErrorCode::outside,
                    fmt::format("no pipe for '{}': {}", request_.command.front(), std::strerror(errno)));
    std::vector<std::string> command = request_.command;
    std::vector<std::string> environment = environment_with(request_.environment);
    std::vector<char*> arguments = pointers_to(command), variables = pointers_to(environment);
    const int error = spawn(arguments, variables);
    if (error != 0)
        return fail(ErrorCode::outside,
                    fmt::format("cannot start '{}': {}", request_.command.front(), std::strerror(error)));
    if (request_.group) request_.group(child_);
    output_.write = FileDescriptor();
    errors_.write = FileDescriptor();
    for (const int end : {output_.read.value(), errors_.read.value()})
        ::fcntl(end, F_SETFL, ::fcntl(end, F_GETFL) | O_NONBLOCK);
    return {};
}

// The child stays unreaped, so that its number, which is the group's too, belongs to nobody else.
bool RunningProcess::is_over() {
    siginfo_t info{};
    return ::waitid(P_PID, static_cast<id_t>(child_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid == child_;
}

ProcessOutcome RunningProcess::wait() {
    const auto end = ProcessClock::now() + std::chrono::duration<double>(request_.timeout.value());
    while (!outcome_.enough) {
        const bool over = is_over();
        read_outputs(over ? 0 : look_every_ms);
        if (over) break;
        outcome_.cancelled = request_.cancelled && request_.cancelled();
        outcome_.timed_out = !outcome_.cancelled && ProcessClock::now() >= end;
        if (outcome_.cancelled || outcome_.timed_out) break;
    }
    end_group();
    if (!line_.empty() && !outcome_.enough) take_line();
    return outcome_;
}

void RunningProcess::read_outputs(int patience_ms) {
    std::array<pollfd, 2> polled{{{output_.read.value(), POLLIN, 0}, {errors_.read.value(), POLLIN, 0}}};
    ::poll(polled.data(), polled.size(), patience_ms);
    if ((polled[0].revents & (POLLIN | POLLHUP)) != 0 && !read_some(output_, outcome_.output, true))
        output_.read = FileDescriptor();
    if ((polled[1].revents & (POLLIN | POLLHUP)) != 0 && !read_some(errors_, outcome_.errors, false))
        errors_.read = FileDescriptor();
}

// Reads at most what a pipe holds, so that a flood does not keep the clock from being looked at. False at its end.
bool RunningProcess::read_some(Pipe& pipe, std::string& kept, bool lines) {
    std::array<char, 65536> bytes{};
    for (int round = 0; round < 16 && !outcome_.enough; ++round) {
        const ssize_t count = ::read(pipe.read.value(), bytes.data(), bytes.size());
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return errno == EAGAIN;
        if (count == 0) return false;
        const std::string_view some(bytes.data(), static_cast<std::size_t>(count));
        const std::size_t room = request_.output_limit - kept.size();
        kept += some.substr(0, room);
        outcome_.output_cut = outcome_.output_cut || some.size() > room;
        if (lines && request_.line) take_lines(some);
    }
    return true;
}

void RunningProcess::take_lines(std::string_view bytes) {
    for (const char byte : bytes) {
        if (outcome_.enough) return;
        if (byte == '\n')
            take_line();
        else if (line_.size() < longest_line)
            line_ += byte;
    }
}

void RunningProcess::take_line() {
    outcome_.enough = request_.line && request_.line(line_);
    line_.clear();
}

void RunningProcess::end_group() {
    if (child_ < 0) return;
    const bool over = is_over();
    ::kill(-child_, SIGKILL);
    if (request_.group) request_.group(std::nullopt);
    int status = 0;
    while (::waitpid(child_, &status, 0) < 0 && errno == EINTR) {
    }
    child_ = -1;
    if (over && WIFEXITED(status)) outcome_.exit_code = WEXITSTATUS(status);
    if (WIFSIGNALED(status)) outcome_.signal = WTERMSIG(status);
}

}  // namespace

Result<ProcessOutcome> run_process(const ProcessRequest& request) {
    RunningProcess process(request);
    if (const auto started = process.start(); !started) return fail(started.error());
    return process.wait();
}

}  // namespace skyloop::inline base
