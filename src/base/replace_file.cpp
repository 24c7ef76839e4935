#include "skyloop/base/replace_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "skyloop/base/steady_clock.hpp"

namespace skyloop {
namespace {

std::error_code last_error() { return {errno, std::generic_category()}; }

std::error_code write_whole(int descriptor, std::string_view content) {
    while (!content.empty()) {
        const ssize_t wrote = ::write(descriptor, content.data(), content.size());
        if (wrote < 0 && errno != EINTR) return last_error();
        if (wrote > 0) content.remove_prefix(static_cast<std::size_t>(wrote));
    }
    return {};
}

std::error_code write_new_file(const std::filesystem::path& path, std::string_view content) {
    const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor < 0) return last_error();
    std::error_code reason = write_whole(descriptor, content);
    // Some file systems tell only now that there is no room.
    if (::close(descriptor) != 0 && !reason) reason = last_error();
    return reason;
}

}  // namespace

Result<void> replace_file(const std::filesystem::path& path, std::string_view content) {
    // A name of its own for each who writes.
    const std::filesystem::path fresh = fmt::format("{}.{}-{:x}.new", path.string(), ::getpid(), steady_clock_ns());
    std::error_code reason = write_new_file(fresh, content);
    if (!reason) std::filesystem::rename(fresh, path, reason);
    if (!reason) return {};
    std::error_code ignored;
    std::filesystem::remove(fresh, ignored);
    return fail(ErrorCode::outside, fmt::format("{}: cannot be written: {}", path.string(), reason.message()));
}

}  // namespace skyloop
