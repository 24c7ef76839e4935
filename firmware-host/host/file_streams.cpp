#include "file_streams.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "base/core/files.hpp"
#include "run/emulator/run_files.hpp"

namespace skyloop::host {
namespace {

constexpr int read_patience_ms = 200;
constexpr std::size_t read_portion = 4096;

tl::unexpected<Error> read_refused(const std::string& name) {
    return fail(ErrorCode::outside, fmt::format("{}: cannot be read: {}", name, std::strerror(errno)));
}

}  // namespace

Result<InputStream> InputStream::open(const std::string& path) {
    InputStream stream;
    stream.name_ = path == "-" ? "standard input" : path;
    if (path == "-") {
        stream.fd_ = STDIN_FILENO;
    } else {
        stream.fd_ = ::open(path.c_str(), O_RDONLY | O_NOCTTY | O_CLOEXEC);
        if (stream.fd_ < 0) return read_refused(path);
        stream.close_ = true;
    }
    if (const auto ready = stream.prepare(); !ready) return fail(ready.error());
    return stream;
}

Result<void> InputStream::prepare() {
    struct stat status {};
    if (fstat(fd_, &status) != 0) return read_refused(name_);
    file_ = S_ISREG(status.st_mode);
    tty_ = isatty(fd_) == 1;
    // Not the terminal that somebody types at: Ctrl-C must keep its meaning there.
    if (!tty_ || tcgetpgrp(fd_) >= 0) return {};
    struct termios modes {};
    if (tcgetattr(fd_, &modes) != 0) return read_refused(name_);
    saved_modes_.assign(reinterpret_cast<const char*>(&modes), sizeof modes);
    cfmakeraw(&modes);
    if (tcsetattr(fd_, TCSANOW, &modes) != 0) return read_refused(name_);
    return {};
}

InputStream::InputStream(InputStream&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)),
      close_(std::exchange(other.close_, false)),
      tty_(other.tty_),
      file_(other.file_),
      at_end_(other.at_end_),
      name_(std::move(other.name_)),
      saved_modes_(std::exchange(other.saved_modes_, {})) {}

InputStream::~InputStream() {
    if (!saved_modes_.empty()) {
        struct termios modes {};
        std::memcpy(&modes, saved_modes_.data(), sizeof modes);
        tcsetattr(fd_, TCSANOW, &modes);
    }
    if (close_) ::close(fd_);
}

Result<Bytes> InputStream::read() {
    struct pollfd wait {
        fd_, POLLIN, 0
    };
    const int ready = poll(&wait, 1, read_patience_ms);
    if (ready < 0 && errno != EINTR) return read_refused(name_);
    if (ready <= 0) return Bytes{};
    Bytes bytes(read_portion);
    const ssize_t count = ::read(fd_, bytes.data(), bytes.size());
    if (count < 0 && (errno == EINTR || errno == EAGAIN)) return Bytes{};
    // A pty whose other side is closed says so by an error.
    if (count < 0 && !(tty_ && errno == EIO)) return read_refused(name_);
    at_end_ = count <= 0;
    bytes.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
    return bytes;
}

Result<void> write_whole_file(const std::filesystem::path& path, std::string_view text) {
    auto file = OutputFile::create(path);
    if (!file) return fail(file.error());
    file->write(text);
    file->flush();
    if (file->failure()) return fail(*file->failure());
    return {};
}

Result<void> check_made_by(std::string_view command, const std::vector<std::filesystem::path>& files) {
    const auto is_there = [](const std::filesystem::path& file) {
        std::error_code absent;
        return std::filesystem::is_regular_file(file, absent);
    };
    const std::filesystem::path& first = files.front();
    if (is_there(first) && first_line_of(first).starts_with(fmt::format("# Made by skyloop {}", command))) return {};
    const auto found = std::find_if(files.begin(), files.end(), is_there);
    if (found == files.end()) return {};
    return fail(ErrorCode::usage, fmt::format("{}: is there already, and not by {}; expected --out with another folder",
                                              found->string(), command));
}

}  // namespace skyloop::host
