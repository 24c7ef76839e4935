#include "run/emulator/run_files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "base/core/files.hpp"

namespace skyloop::inline run {

Result<ClaimedFolder> ClaimedFolder::claim(const std::filesystem::path& path) {
    ClaimedFolder folder;
    const auto made = make_folder(path);
    if (!made) return fail(made.error());
    folder.made_ = *made;
    folder.path_ = path;
    folder.lock_ = FileDescriptor(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    // The system takes the lock back however a program ends. Network file systems may have none; there nothing is held.
    if (folder.lock_.open() && ::flock(folder.lock_.value(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
        return fail(ErrorCode::outside,
                    fmt::format("{}: another run is recording there; expected another folder", path.string()));
    return folder;
}

ClaimedFolder& ClaimedFolder::operator=(ClaimedFolder&& other) noexcept {
    std::swap(path_, other.path_);
    std::swap(lock_, other.lock_);
    std::swap(made_, other.made_);
    return *this;
}

ClaimedFolder::~ClaimedFolder() {
    std::error_code not_empty;
    if (made_) std::filesystem::remove(path_, not_empty);
}

Result<OutputFile> OutputFile::create(const std::filesystem::path& path) {
    OutputFile file;
    file.path_ = path;
    file.descriptor_ = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (file.descriptor_ < 0)
        return fail(ErrorCode::outside, fmt::format("{}: cannot be written: {}", path.string(), std::strerror(errno)));
    return file;
}

// A path to it (/dev/stdout) would open a regular file anew: emptied, with a place in it of its own. Sockets have none.
Result<OutputFile> OutputFile::standard_output() {
    OutputFile file;
    file.path_ = "standard output";
    file.descriptor_ = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0);
    if (file.descriptor_ < 0)
        return fail(ErrorCode::outside, fmt::format("standard output: cannot be written: {}", std::strerror(errno)));
    return file;
}

OutputFile::OutputFile(OutputFile&& other) noexcept { *this = std::move(other); }

OutputFile& OutputFile::operator=(OutputFile&& other) noexcept {
    std::swap(path_, other.path_);
    std::swap(descriptor_, other.descriptor_);
    std::swap(buffer_, other.buffer_);
    std::swap(failure_, other.failure_);
    return *this;
}

OutputFile::~OutputFile() {
    if (descriptor_ < 0) return;
    flush();
    close(descriptor_);
}

void OutputFile::write(std::string_view text) {
    constexpr std::size_t piece = std::size_t{1} << 18;
    buffer_ += text;
    if (buffer_.size() >= piece) flush();
}

void OutputFile::write(ByteSpan bytes) {
    write(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

void OutputFile::flush() {
    std::size_t done = 0;
    while (done < buffer_.size() && !failure_) {
        const ssize_t wrote = ::write(descriptor_, buffer_.data() + done, buffer_.size() - done);
        if (wrote >= 0)
            done += static_cast<std::size_t>(wrote);
        else if (errno != EINTR)
            failure_ =
                Error{ErrorCode::outside, fmt::format("{}: cannot be written: {}; what was written before is kept",
                                                      path_.string(), std::strerror(errno))};
    }
    buffer_.clear();
}

Result<void> create_files(const std::filesystem::path& folder,
                          std::initializer_list<std::pair<OutputFile*, std::string>> files) {
    for (const auto& [file, name] : files) {
        auto created = OutputFile::create(folder / name);
        if (!created) return fail(created.error());
        *file = std::move(*created);
    }
    return {};
}

namespace {

constexpr std::size_t largest_state = std::size_t{1} << 20;
constexpr Nanoseconds pause = std::chrono::seconds(1);

}  // namespace

Result<StateFile> StateFile::open(const std::filesystem::path& path) {
    StateFile file(path);
    std::error_code reason;
    if (!std::filesystem::exists(path, reason) && !reason) return file;
    auto text = read_text_file(path, largest_state);
    if (!text) return fail(text.error());
    file.text_ = std::move(*text);
    return file;
}

bool StateFile::due(GpsTime now) const { return !looked_ || now - *looked_ >= pause; }

void StateFile::keep(const std::string& text, GpsTime now) {
    looked_ = now;
    if (text.empty() || text == text_) return;
    if (const auto replaced = replace_file(path_, text); !replaced) {
        failure_ = replaced.error();
        return;
    }
    failure_.reset();
    text_ = text;
}

}  // namespace skyloop::inline run
