#include "base/core/watchdog_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <map>
#include <thread>

namespace skyloop::inline base {
namespace {

constexpr int watchdog_socket = 3;

// What one of an OrphanWatchdog's listeners heard; no group: what it had has been ended.
struct GroupRecord {
    std::int32_t listener = 0, group = 0;
};

void leave_the_program(int socket, const char* name) {
    ::setsid();
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE})
        ::signal(signal, SIG_IGN);
    sigset_t none;
    ::sigemptyset(&none);
    ::sigprocmask(SIG_SETMASK, &none, nullptr);
    ::prctl(PR_SET_NAME, name);
    // Whoever reads what the program prints waits for the last owner of that pipe.
    const int nowhere = ::open("/dev/null", O_RDWR);
    ::dup2(nowhere, STDIN_FILENO);
    ::dup2(nowhere, STDOUT_FILENO);
    // Not left to close_range(2), which a library that follows close(2) does not see: umockdev would go on to take the
    // next file of this number for it, and close another one with it.
    if (nowhere > STDERR_FILENO) ::close(nowhere);
    ::dup2(socket, watchdog_socket);
    ::close_range(watchdog_socket + 1, ~0U, 0);
}

[[noreturn]] void stand_by(int socket, const char* name, const std::function<void(int)>& work) noexcept {
    leave_the_program(socket, name);
    work(watchdog_socket);
    ::_exit(0);
}

}  // namespace

Result<std::unique_ptr<WatchdogProcess>> WatchdogProcess::start(const char* name,
                                                                const std::function<void(int)>& work) {
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0)
        return fail(ErrorCode::outside, std::strerror(errno));
    FileDescriptor ours(ends[0]);
    const FileDescriptor theirs(ends[1]);
    const pid_t child = ::fork();
    if (child == 0) stand_by(theirs.value(), name, work);
    if (child > 0) return std::unique_ptr<WatchdogProcess>(new WatchdogProcess(child, std::move(ours)));
    return fail(ErrorCode::outside, std::strerror(errno));
}

WatchdogProcess::~WatchdogProcess() {
    socket_ = FileDescriptor();
    while (::waitpid(child_, nullptr, 0) < 0 && errno == EINTR) {
    }
}

bool WatchdogProcess::tell(const void* record, std::size_t size) const {
    return ::send(socket_.value(), record, size, MSG_NOSIGNAL) == static_cast<ssize_t>(size);
}

bool hear_record(int socket, void* record, std::size_t size) {
    for (;;) {
        const ssize_t heard = ::recv(socket, record, size, 0);
        if (heard < 0 && errno == EINTR) continue;
        return heard == static_cast<ssize_t>(size);
    }
}

void end_process_group(int group) {
    constexpr std::chrono::milliseconds look_every{10};
    // Not for ever: where nobody reaps orphans, as in many a container, their group stays.
    constexpr int most_looks = 100;
    ::kill(-group, SIGKILL);
    for (int i = 0; i < most_looks && ::kill(-group, 0) == 0; ++i)
        std::this_thread::sleep_for(look_every);
}

Result<std::unique_ptr<OrphanWatchdog>> OrphanWatchdog::start() {
    auto process = WatchdogProcess::start("skyloop-orphans", [](int socket) {
        std::map<std::int32_t, std::int32_t> groups;
        GroupRecord heard;
        while (hear_record(socket, &heard, sizeof heard))
            if (heard.group > 0)
                groups[heard.listener] = heard.group;
            else
                groups.erase(heard.listener);
        for (const auto& [listener, group] : groups)
            end_process_group(group);
    });
    if (!process) return fail(process.error());
    return std::unique_ptr<OrphanWatchdog>(new OrphanWatchdog(std::move(*process)));
}

ProcessGroupListener OrphanWatchdog::listener() {
    return [this, listener = ++listeners_](std::optional<int> group) {
        const GroupRecord record{listener, group.value_or(0)};
        process_->tell(&record, sizeof record);
    };
}

}  // namespace skyloop::inline base
