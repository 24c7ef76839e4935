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
    std::int32_t group = 0;  // of processes; 0: none
};
constexpr char noted_cut = 'c', noted_restored = 'r', noted_group = 'g';

constexpr int tries_to_restore = 5;
constexpr std::chrono::milliseconds between_tries{300};  // a hub may take that long to come back

// What the program left behind of a ward.
struct WardLeft {
    bool cut = false;
    pid_t group = 0;  // of the command that was at work on it
};

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

// How things stand when the program is gone.
std::vector<WardLeft> follow_notes(int socket, std::size_t wards) {
    std::vector<WardLeft> left(wards);
    for (;;) {
        WatchdogNote note;
        const ssize_t size = ::recv(socket, &note, sizeof(note), 0);
        if (size < 0 && errno == EINTR) continue;
        if (size != static_cast<ssize_t>(sizeof(note))) return left;
        if (note.ward >= wards) continue;
        if (note.what == noted_group)
            left[note.ward].group = note.group;
        else
            left[note.ward].cut = note.what == noted_cut;
    }
}

// A command that outlives the program would cut the power after it has been restored.
void end_group(pid_t group) {
    constexpr std::chrono::milliseconds look_every{10};
    // Not for ever: where nobody reaps orphans, as in many a container, their group stays.
    constexpr int most_looks = 100;
    ::kill(-group, SIGKILL);
    for (int i = 0; i < most_looks && ::kill(-group, 0) == 0; ++i)
        std::this_thread::sleep_for(look_every);
}

// Restored, and still so when what was under way before has had its time.
Result<void> restore_for_good(const std::string& uri) {
    const auto actuator = open_actuator(uri);
    if (!actuator) return fail(actuator.error());
    if (auto done = (*actuator)->restore(); !done) return done;
    std::this_thread::sleep_for(between_tries);
    const auto state = (*actuator)->state();
    if (state && *state == PowerState::cut) return fail(ErrorCode::outside, "it was cut again by something else");
    return {};
}

void restore_ward(const std::string& uri) {
    std::string reason;
    for (int i = 0; i < tries_to_restore; ++i) {
        if (i > 0) std::this_thread::sleep_for(between_tries);
        const Result<void> done = restore_for_good(uri);
        if (done) return fmt::print(stderr, "skyloop: power {}: restored, as the run had not done so\n", uri);
        reason = done.error().message;
    }
    fmt::print(stderr, "skyloop: power {}: the run left it cut, and it cannot be restored: {}\n", uri, reason);
}

[[noreturn]] void watch_over(int socket, const std::vector<std::string>& wards) noexcept {
    leave_the_program(socket);
    constexpr int kept = 3;
    const std::vector<WardLeft> left = follow_notes(kept, wards.size());
    for (const WardLeft& ward : left)
        if (ward.cut && ward.group > 0) end_group(ward.group);
    for (std::size_t i = 0; i < wards.size(); ++i)
        if (left[i].cut) restore_ward(wards[i]);
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

bool PowerWatchdog::note(char what, std::size_t ward, int group) const {
    const WatchdogNote note{what, static_cast<std::uint32_t>(ward), group};
    return ::send(socket_, &note, sizeof(note), MSG_NOSIGNAL) == static_cast<ssize_t>(sizeof(note));
}

Result<void> PowerWatchdog::note_cut(std::size_t ward) {
    if (note(noted_cut, ward)) return {};
    return fail(ErrorCode::outside,
                fmt::format("the watchdog that would restore it is gone: {}", std::strerror(errno)));
}

void PowerWatchdog::note_restored(std::size_t ward) { static_cast<void>(note(noted_restored, ward)); }

void PowerWatchdog::note_group(std::size_t ward, std::optional<int> group) {
    static_cast<void>(note(noted_group, ward, group.value_or(0)));
}

}  // namespace skyloop
