#include "skyloop/actuator/power_watchdog.hpp"

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
#include <thread>

#include "skyloop/actuator/actuator_uri.hpp"

namespace skyloop {
namespace {

// One record of the socket, which keeps their borders.
struct WatchdogNote {
    char what = 0;
    std::uint32_t ward = 0;
};
constexpr char noted_cut = 'c', noted_restored = 'r';

constexpr int tries_to_restore = 5;
constexpr std::chrono::milliseconds between_tries{300};  // a hub may take that long to come back

void leave_the_program(int socket) {
    ::setsid();
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE})
        ::signal(signal, SIG_IGN);
    sigset_t none;
    ::sigemptyset(&none);
    ::sigprocmask(SIG_SETMASK, &none, nullptr);
    ::prctl(PR_SET_NAME, "skyloop-power");
    // Whoever reads what the program prints waits for the last owner of that pipe.
    const int nowhere = ::open("/dev/null", O_RDWR);
    ::dup2(nowhere, STDIN_FILENO);
    ::dup2(nowhere, STDOUT_FILENO);
    // Not left to close_range(2), which a library that follows close(2) does not see: umockdev would go on to take the
    // next file of this number for it, and close another one with it.
    if (nowhere > STDERR_FILENO) ::close(nowhere);
    constexpr int kept = 3;
    ::dup2(socket, kept);
    ::close_range(kept + 1, ~0U, 0);
}

// What is cut when the program is gone.
std::vector<bool> follow_notes(int socket, std::size_t wards) {
    std::vector<bool> cut(wards);
    for (;;) {
        WatchdogNote note;
        const ssize_t size = ::recv(socket, &note, sizeof(note), 0);
        if (size < 0 && errno == EINTR) continue;
        if (size != static_cast<ssize_t>(sizeof(note))) return cut;
        if (note.ward < wards) cut[note.ward] = note.what == noted_cut;
    }
}

void restore_ward(const std::string& uri) {
    std::string reason;
    for (int i = 0; i < tries_to_restore; ++i) {
        if (i > 0) std::this_thread::sleep_for(between_tries);
        const auto actuator = open_actuator(uri);
        const Result<void> done = actuator ? (*actuator)->restore() : Result<void>(fail(actuator.error()));
        if (done) return fmt::print(stderr, "skyloop: power {}: restored, as the run had not done so\n", uri);
        reason = done.error().message;
    }
    fmt::print(stderr, "skyloop: power {}: the run left it cut, and it cannot be restored: {}\n", uri, reason);
}

[[noreturn]] void watch_over(int socket, const std::vector<std::string>& wards) noexcept {
    leave_the_program(socket);
    constexpr int kept = 3;
    const std::vector<bool> cut = follow_notes(kept, wards.size());
    for (std::size_t i = 0; i < wards.size(); ++i)
        if (cut[i]) restore_ward(wards[i]);
    ::_exit(0);
}

}  // namespace

Result<std::unique_ptr<PowerWatchdog>> PowerWatchdog::start(const std::vector<std::string>& wards) {
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0)
        return fail(ErrorCode::outside, fmt::format("no watchdog over the power: {}", std::strerror(errno)));
    const pid_t child = ::fork();
    if (child == 0) watch_over(ends[1], wards);
    ::close(ends[1]);
    if (child > 0) return std::unique_ptr<PowerWatchdog>(new PowerWatchdog(child, ends[0]));
    ::close(ends[0]);
    return fail(ErrorCode::outside, fmt::format("no watchdog over the power: {}", std::strerror(errno)));
}

PowerWatchdog::~PowerWatchdog() {
    ::close(socket_);
    while (::waitpid(child_, nullptr, 0) < 0 && errno == EINTR) {
    }
}

bool PowerWatchdog::note(char what, std::size_t ward) const {
    const WatchdogNote note{what, static_cast<std::uint32_t>(ward)};
    return ::send(socket_, &note, sizeof(note), MSG_NOSIGNAL) == static_cast<ssize_t>(sizeof(note));
}

Result<void> PowerWatchdog::note_cut(std::size_t ward) {
    if (note(noted_cut, ward)) return {};
    return fail(ErrorCode::outside,
                fmt::format("the watchdog that would restore it is gone: {}", std::strerror(errno)));
}

void PowerWatchdog::note_restored(std::size_t ward) { static_cast<void>(note(noted_restored, ward)); }

}  // namespace skyloop
