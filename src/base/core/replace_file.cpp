#include "base/core/replace_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "base/core/steady_clock.hpp"

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

std::error_code write_file(const std::filesystem::path& path, int flags, std::string_view content) {
    const int descriptor = ::open(path.c_str(), O_WRONLY | O_CLOEXEC | flags, 0666);
    if (descriptor < 0) return last_error();
    std::error_code reason = write_whole(descriptor, content);
    // Some file systems tell only now that there is no room.
    if (::close(descriptor) != 0 && !reason) reason = last_error();
    return reason;
}

// What a link leads to, whether it is there or not.
std::filesystem::path end_of_links(std::filesystem::path path) {
    constexpr int most_links = 40;  // as Linux follows
    std::error_code none;
    for (int i = 0; i < most_links && std::filesystem::is_symlink(path, none); ++i)
        path = path.parent_path() / std::filesystem::read_symlink(path, none);
    return path;
}

// Devices and pipes are written to, not replaced; nor are links that lead nowhere.
bool is_replaceable(const std::filesystem::path& path) {
    std::error_code none;
    if (std::filesystem::is_symlink(path, none)) return false;
    return !std::filesystem::exists(path, none) || std::filesystem::is_regular_file(path, none);
}

std::error_code put_in_place(const std::filesystem::path& path, std::string_view content) {
    // A name of its own for each who writes.
    const std::filesystem::path fresh = fmt::format("{}.{}-{:x}.new", path.string(), ::getpid(), steady_clock_ns());
    std::error_code reason = write_file(fresh, O_CREAT | O_EXCL, content);
    if (!reason) std::filesystem::rename(fresh, path, reason);
    std::error_code ignored;
    if (reason) std::filesystem::remove(fresh, ignored);
    return reason;
}

tl::unexpected<Error> not_written(const std::filesystem::path& path, const std::error_code& reason) {
    return fail(ErrorCode::outside, fmt::format("{}: cannot be written: {}", path.string(), reason.message()));
}

}  // namespace

Result<void> replace_file(const std::filesystem::path& path, std::string_view content) {
    const std::filesystem::path file = end_of_links(path);
    const std::error_code reason = is_replaceable(file) ? put_in_place(file, content) : write_file(file, 0, content);
    if (!reason) return {};
    return not_written(path, reason);
}

Result<void> check_replaceable(const std::filesystem::path& path) {
    const std::filesystem::path file = end_of_links(path);
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
    // With "/" behind it, so that a file is no folder.
    const bool can =
        is_replaceable(file) ? ::access((folder / "").c_str(), W_OK | X_OK) == 0 : ::access(file.c_str(), W_OK) == 0;
    if (can) return {};
    return not_written(path, last_error());
}

}  // namespace skyloop
