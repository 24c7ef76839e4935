#include "campaigns/campaign/keyed_files.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

#include "campaigns/campaign/sha256.hpp"

namespace skyloop::inline campaigns {
namespace {

// A file itself; of a folder all files in it, by name.
Result<std::vector<std::filesystem::path>> files_at(const std::filesystem::path& path) {
    std::error_code none;
    if (!std::filesystem::is_directory(path, none)) return std::vector<std::filesystem::path>{path};
    std::vector<std::filesystem::path> files;
    for (auto at = std::filesystem::recursive_directory_iterator(path, none);
         !none && at != std::filesystem::recursive_directory_iterator(); at.increment(none))
        if (at->is_regular_file(none)) files.push_back(at->path());
    if (none) return fail(ErrorCode::outside, fmt::format("{}: cannot be read: {}", path.string(), none.message()));
    std::sort(files.begin(), files.end());
    return files;
}

// Adds the content of one file.
Result<void> add_file_content(Sha256& digest, const std::filesystem::path& file) {
    std::error_code none;  // a device may have no end, and a fifo waits for a peer; what is not there is told below
    if (std::filesystem::exists(file, none) && !std::filesystem::is_regular_file(file, none))
        return fail(ErrorCode::outside, fmt::format("{}: is not a regular file", file.string()));
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> opened(std::fopen(file.c_str(), "rb"), &std::fclose);
    std::array<char, 65536> piece{};
    while (opened) {
        const std::size_t count = std::fread(piece.data(), 1, piece.size(), opened.get());
        digest.add({piece.data(), count});
        if (count == piece.size()) continue;
        if (std::ferror(opened.get()) != 0) break;
        return {};
    }
    return fail(ErrorCode::outside, fmt::format("{}: cannot be read: {}", file.string(), std::strerror(errno)));
}

Result<std::string> content_digest(const std::filesystem::path& path) {
    const auto files = files_at(path);
    if (!files) return fail(files.error());
    Sha256 digest;
    for (const auto& file : *files) {
        if (file != path) digest.add(fmt::format("{}\n", file.lexically_relative(path).string()));
        if (const auto added = add_file_content(digest, file); !added) return fail(added.error());
    }
    return digest.hex();
}

// Another where the content is; a file that was put in the place of another, with its times, is another inode.
std::string content_stamp(const std::filesystem::path& path) {
    std::string stamp;
    for (const auto& file : files_at(path).value_or(std::vector<std::filesystem::path>())) {
        struct stat found {};
        if (::stat(file.c_str(), &found) != 0) continue;
        stamp += fmt::format("{} {} {}.{:09} {}\n", file.string(), found.st_size, found.st_mtim.tv_sec,
                             found.st_mtim.tv_nsec, found.st_ino);
    }
    return stamp;
}

}  // namespace

Result<std::string> KeyedFiles::digest(const std::filesystem::path& path) {
    if (const auto seen = seen_.find(path); seen != seen_.end()) return seen->second.digest;
    // First, so that what is written meanwhile is seen by the next look.
    std::string stamp = content_stamp(path);
    auto digest = content_digest(path);
    if (digest) seen_[path] = {std::move(stamp), *digest};
    return digest;
}

Result<std::optional<std::filesystem::path>> KeyedFiles::find_written() {
    std::optional<std::filesystem::path> written;
    for (auto& [path, seen] : seen_) {
        std::string stamp = content_stamp(path);
        if (stamp == seen.stamp) continue;
        const auto digest = content_digest(path);
        if (!digest) return fail(digest.error());
        if (*digest != seen.digest)
            return fail(ErrorCode::outside,
                        fmt::format("{}: has changed since the campaign began; what was done before is kept, and the "
                                    "same command goes on with what it is now",
                                    path.string()));
        seen.stamp = std::move(stamp);
        written = path;
    }
    return written;
}

}  // namespace skyloop::inline campaigns
