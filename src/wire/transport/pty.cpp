#include "wire/transport/pty.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/inotify.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <utility>

#include "detail/line_settings.hpp"

namespace skyloop::inline wire {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t initial_baud = 9600;

tl::unexpected<Error> refused(const std::string& what) {
    return fail(ErrorCode::outside, fmt::format("{}: {}", what, std::strerror(errno)));
}

bool set_speed(int master, std::uint32_t baud) {
    termios2 settings{};
    if (::ioctl(master, TCGETS2, &settings) != 0) return false;
    put_speed(settings, baud);
    return ::ioctl(master, TCSETS2, &settings) == 0;
}

bool set_raw(int master) {
    termios2 settings{};
    if (::ioctl(master, TCGETS2, &settings) != 0) return false;
    make_raw(settings);
    return ::ioctl(master, TCSETS2, &settings) == 0;
}

FileDescriptor open_slave(int master) {
    return FileDescriptor(::ioctl(master, TIOCGPTPEER, O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
}

// Of the master: "hung up" says, once the terminal has been open, that nobody has it open now.
short poll_master(int master) {
    pollfd state{master, POLLIN, 0};
    ::poll(&state, 1, 0);
    return state.revents;
}

// As claim_name() of one that names the folder itself, since other names of it, or another folder of the same name in a
// container, may be there too.
FileDescriptor claim_of(const fs::path& link) {
    struct stat folder {};
    if (::stat(link.parent_path().c_str(), &folder) != 0) return {};
    return claim_name(fmt::format("skyloop pty {:x}:{:x} {:x}", folder.st_dev, folder.st_ino,
                                  std::hash<std::string>{}(link.filename().string())));
}

// As a run that died has left its link: what it led to is gone, or is another program's by now.
bool leads_to_pty(const fs::path& target) { return target.string().starts_with("/dev/pts/"); }

}  // namespace

Result<std::unique_ptr<PtyTransport>> PtyTransport::open(const std::optional<fs::path>& link) {
    FileDescriptor master(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
    if (!master.open()) return refused("no pseudo-terminal can be had (/dev/ptmx)");
    std::array<char, 64> name{};
    if (::grantpt(master.value()) != 0 || ::unlockpt(master.value()) != 0 ||
        ::ptsname_r(master.value(), name.data(), name.size()) != 0)
        return refused("the pseudo-terminal cannot be unlocked");
    std::unique_ptr<PtyTransport> pty(new PtyTransport(std::move(master), name.data()));
    if (const auto prepared = pty->prepare(); !prepared) return fail(prepared.error());
    if (link)
        if (const auto published = pty->publish(*link); !published) return fail(published.error());
    return pty;
}

Result<void> PtyTransport::prepare() {
    if (!set_raw(master_.value()) || !set_speed(master_.value(), initial_baud)) return refused(terminal_);
    // A client seldom runs as the same user. Where the node cannot be changed it keeps the rights the system gave it.
    (void)::chmod(terminal_.c_str(), 0666);
    // Before its first open a terminal is not "hung up"; after this both cases look alike.
    if (!open_slave(master_.value()).open()) return refused(terminal_);
    events_ = FileDescriptor(::inotify_init1(IN_NONBLOCK | IN_CLOEXEC));
    watch();
    return {};
}

Result<void> PtyTransport::publish(const fs::path& link) {
    std::error_code error;
    const fs::path target = fs::absolute(link, error).lexically_normal();
    const fs::file_status there = fs::symlink_status(target, error);
    if (fs::exists(there) && !fs::is_symlink(there))
        return fail(ErrorCode::outside,
                    fmt::format("{}: is there already and is not a symbolic link; it is left alone", link.string()));
    const fs::path other = fs::is_symlink(there) ? fs::read_symlink(target, error) : fs::path();
    if (fs::is_symlink(there) && !leads_to_pty(other))
        return fail(ErrorCode::outside,
                    fmt::format("{}: is a link to {}, which is no pseudo-terminal; it is left alone", link.string(),
                                other.string()));
    if (!fs::is_directory(target.parent_path(), error))
        return fail(ErrorCode::outside,
                    fmt::format("{}: the folder {} does not exist", link.string(), target.parent_path().string()));
    claim_ = claim_of(target);
    if (!claim_.open() && errno == EADDRINUSE)
        return fail(ErrorCode::outside,
                    fmt::format("{}: a terminal of another run is published there; it is left alone", link.string()));
    const std::string fresh = fmt::format("{}.{}.new", target.string(), ::getpid());
    (void)::unlink(fresh.c_str());
    if (::symlink(terminal_.c_str(), fresh.c_str()) != 0) return refused(link.string() + ": the link cannot be made");
    if (::rename(fresh.c_str(), target.c_str()) != 0) {
        const auto error_line = refused(link.string() + ": the link cannot be made");
        (void)::unlink(fresh.c_str());
        return error_line;
    }
    link_ = target;
    return {};
}

PtyTransport::~PtyTransport() {
    std::error_code error;
    if (!link_.empty() && fs::read_symlink(link_, error) == terminal_) fs::remove(link_, error);
}

void PtyTransport::watch() {
    if (events_.open()) watch_ = ::inotify_add_watch(events_.value(), terminal_.c_str(), IN_OPEN | IN_CLOSE);
}

// Counts the opens and closes that have been reported; true when a client came that was alone.
bool PtyTransport::read_events() {
    bool alone = false;
    alignas(inotify_event) std::array<char, 4096> buffer;
    ssize_t size = 0;
    while (events_.open() && (size = ::read(events_.value(), buffer.data(), buffer.size())) > 0) {
        for (ssize_t at = 0; at < size;) {
            inotify_event event{};
            std::memcpy(&event, buffer.data() + at, sizeof event);
            at += static_cast<ssize_t>(sizeof event + event.len);
            if ((event.mask & IN_OPEN) != 0 && !std::exchange(counted_early_, false)) alone |= clients_++ == 0;
            if ((event.mask & IN_CLOSE) != 0) clients_ = std::max(0, clients_ - 1);
        }
    }
    return alone;
}

// One system call while nobody comes or goes: it is made every millisecond for each port.
void PtyTransport::follow_clients() {
    std::array<pollfd, 2> ends{{{master_.value(), POLLIN, 0}, {events_.value(), POLLIN, 0}}};
    ::poll(ends.data(), events_.open() ? 2 : 1, 0);
    short master = ends[0].revents;
    bool somebody_new = false;
    if ((ends[1].revents & POLLIN) != 0) {
        somebody_new = read_events();
        master = poll_master(master_.value());  // not older than what was reported
    }
    readable_ = (master & POLLIN) != 0;
    // The kernel joins equal events that follow each other, so the count may drift; the hang-up state never does.
    if ((master & POLLHUP) != 0) {
        clients_ = 0;
        counted_early_ = false;
    } else if (clients_ == 0) {
        clients_ = 1;
        counted_early_ = true;  // the report of this open is still to come
    }
    if ((clients_ == 0 || somebody_new) && unread_possible_) forget_unread();
}

// Bytes that a client left would reach the next one as if they were fresh. Part of them wait in the driver, part in the
// line discipline of the clients' side, which only a descriptor of that side can empty.
void PtyTransport::forget_unread() {
    (void)::ioctl(master_.value(), TCFLSH, TCOFLUSH);
    // Our own open and close must not count as a client's.
    if (watch_ >= 0) (void)::inotify_rm_watch(events_.value(), watch_);
    if (const FileDescriptor slave = open_slave(master_.value()); slave.open())
        (void)::ioctl(slave.value(), TCFLSH, TCIFLUSH);
    watch();
    unread_possible_ = false;
}

std::size_t PtyTransport::write(ByteSpan bytes) {
    if (!std::exchange(looked_, false)) follow_clients();
    if (clients_ == 0) return bytes.size();
    std::size_t taken = 0;
    while (taken < bytes.size()) {
        const ssize_t count = ::write(master_.value(), bytes.data() + taken, bytes.size() - taken);
        if (count > 0) {
            taken += static_cast<std::size_t>(count);
            unread_possible_ = true;
        } else if (count < 0 && errno == EIO) {
            return bytes.size();  // the client has just gone, and with it the bytes
        } else if (count == 0 || errno != EINTR) {
            break;
        }
    }
    return taken;
}

Bytes PtyTransport::read() {
    constexpr std::size_t most = 65536;  // a client that writes without end must not hold us here
    if (!std::exchange(looked_, false)) follow_clients();
    if (!readable_) return {};
    Bytes all;
    std::array<std::uint8_t, 4096> piece;
    while (all.size() < most) {
        const ssize_t count = ::read(master_.value(), piece.data(), piece.size());
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) break;  // EAGAIN: nothing there; EIO: nobody there
        all.insert(all.end(), piece.begin(), piece.begin() + count);
    }
    return all;
}

LineState PtyTransport::line() {
    follow_clients();
    looked_ = true;
    termios2 settings{};
    LineState state{clients_ > 0, std::nullopt};
    if (::ioctl(master_.value(), TCGETS2, &settings) == 0 && settings.c_ospeed != 0) state.baud = settings.c_ospeed;
    return state;
}

void PtyTransport::set_receiver_baud(std::uint32_t baud) {
    if (!speed_set_) speed_set_ = set_speed(master_.value(), baud);
}

std::string PtyTransport::description() const { return (link_.empty() ? terminal_ : link_.string()) + " (pty)"; }

int PtyTransport::clients() {
    follow_clients();
    return clients_;
}

}  // namespace skyloop::inline wire
