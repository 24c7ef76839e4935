#include "wire/transport/file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <pthread.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstring>

namespace skyloop::inline wire {
namespace {

// While it lives, writing to a pipe whose reader has gone is an error and not the end of the program.
class BrokenPipeIgnored {
public:
    BrokenPipeIgnored() {
        sigemptyset(&pipe_);
        sigaddset(&pipe_, SIGPIPE);
        sigset_t pending;
        sigpending(&pending);
        was_pending_ = sigismember(&pending, SIGPIPE) == 1;
        pthread_sigmask(SIG_BLOCK, &pipe_, &before_);
    }
    ~BrokenPipeIgnored() {
        const int saved = errno;
        const timespec now{};
        if (!was_pending_) sigtimedwait(&pipe_, nullptr, &now);
        pthread_sigmask(SIG_SETMASK, &before_, nullptr);
        errno = saved;
    }
    BrokenPipeIgnored(const BrokenPipeIgnored&) = delete;
    BrokenPipeIgnored& operator=(const BrokenPipeIgnored&) = delete;

private:
    sigset_t pipe_{};
    sigset_t before_{};
    bool was_pending_ = false;
};

// Standard output may be shared with a shell, so it cannot be made non-blocking: ask before each piece. A pipe that is
// ready takes PIPE_BUF bytes without waiting. A signal ends the patience.
ssize_t write_when_ready(int descriptor, ByteSpan bytes, int patience_ms) {
    pollfd ready{descriptor, POLLOUT, 0};
    if (::poll(&ready, 1, patience_ms) <= 0 || (ready.revents & (POLLOUT | POLLERR | POLLHUP)) == 0) return 0;
    const BrokenPipeIgnored guard;
    return ::write(descriptor, bytes.data(), std::min<std::size_t>(bytes.size(), PIPE_BUF));
}

bool is_regular(int descriptor) {
    struct stat kind {};
    return ::fstat(descriptor, &kind) == 0 && S_ISREG(kind.st_mode);
}

}  // namespace

Result<std::unique_ptr<FileTransport>> FileTransport::open(const std::filesystem::path& path) {
    // Non-blocking, so that a named pipe nobody reads is refused instead of waited for.
    const int flags = O_WRONLY | O_CREAT | O_CLOEXEC | O_NONBLOCK | O_NOCTTY;
    FileDescriptor file(::open(path.c_str(), flags | O_EXCL, 0666));
    const bool made = file.open();
    if (!made) file = FileDescriptor(::open(path.c_str(), flags, 0666));
    if (!file.open())
        return fail(ErrorCode::outside, fmt::format("{}: cannot be written: {}", path.string(), std::strerror(errno)));
    const int descriptor = file.value();
    std::unique_ptr<FileTransport> transport(new FileTransport(std::move(file), descriptor, path.string() + " (file)"));
    if (made) transport->made_ = path;
    return transport;
}

FileTransport::~FileTransport() {
    if (!made_.empty()) ::unlink(made_.c_str());
}

void FileTransport::begin() {
    if (begun_) return;
    begun_ = true;
    made_.clear();
    if (owned_.open() && is_regular(descriptor_) && ::ftruncate(descriptor_, 0) != 0)
        failure_ = fmt::format("{}: cannot be emptied: {}", name_, std::strerror(errno));
}

std::unique_ptr<FileTransport> FileTransport::standard_output() {
    return std::unique_ptr<FileTransport>(new FileTransport({}, STDOUT_FILENO, "standard output"));
}

std::size_t FileTransport::write(ByteSpan bytes) {
    begin();
    std::size_t taken = 0;
    while (failure_.empty() && taken < bytes.size()) {
        const ssize_t count = write_when_ready(descriptor_, bytes.subspan(taken), patience_ms_);
        if (count > 0)
            taken += static_cast<std::size_t>(count);
        else if (count == 0 || errno == EAGAIN)
            return taken;
        else if (errno != EINTR)
            failure_ = fmt::format("{}: writing failed: {}", name_, std::strerror(errno));
    }
    return taken;
}

}  // namespace skyloop::inline wire
