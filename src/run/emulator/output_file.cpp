#include "run/emulator/output_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace skyloop {

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

}  // namespace skyloop
