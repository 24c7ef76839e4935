#include "base/core/files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/core/archive.hpp"
#include "base/core/threads.hpp"

namespace skyloop::inline base {
namespace {

constexpr std::size_t most_packing_adds = std::size_t{1} << 20;

tl::unexpected<Error> refuse_size(const std::string& name, std::size_t max_size) {
    return fail(ErrorCode::input,
                fmt::format("{}: has more than {} bytes of text, the most that is read", name, max_size));
}

Result<std::string> bytes_as_they_stand(const std::filesystem::path& path, std::size_t max_size) {
    const auto outside = [&](std::string_view what) {
        return fail(ErrorCode::outside, fmt::format("{}: {}", path.string(), what));
    };
    // A fifo or a device without a peer would hang a run before it starts.
    std::error_code reason;
    const auto status = std::filesystem::status(path, reason);
    if (reason) return outside(reason.message());
    if (!std::filesystem::is_regular_file(status)) return outside("is not a regular file");
    std::ifstream file(path, std::ios::binary);
    constexpr std::size_t block = std::size_t{1} << 16;
    std::string bytes;
    while (file) {
        const std::size_t had = bytes.size();
        bytes.resize(had + block);
        file.read(bytes.data() + had, block);
        bytes.resize(had + static_cast<std::size_t>(file.gcount()));
        // A small file may be larger when it is packed.
        if (bytes.size() > max_size && bytes.size() - max_size > most_packing_adds)
            return refuse_size(path.string(), max_size);
    }
    return file.eof() ? Result<std::string>(std::move(bytes)) : outside(std::strerror(errno));
}

using Unpacking = Result<std::string> (*)(std::string, const std::string&, std::size_t);

Result<std::string> read_through(Unpacking unpack, const std::filesystem::path& path, std::size_t max_size) {
    auto bytes = bytes_as_they_stand(path, max_size);
    auto text = bytes ? unpack(std::move(*bytes), path.string(), max_size) : std::move(bytes);
    return text && text->size() > max_size ? refuse_size(path.string(), max_size) : text;
}

}  // namespace

Result<std::string> read_uncompressed(const std::filesystem::path& path, std::size_t max_size) {
    return read_through(uncompressed, path, max_size);
}

Result<std::string> read_text_file(const std::filesystem::path& path, std::size_t max_size) {
    return read_through(unpacked, path, max_size);
}

std::string first_line_of(const std::filesystem::path& file) {
    std::ifstream in(file);
    std::string line;
    std::getline(in, line);
    return line;
}

std::vector<std::string> names_in(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    std::error_code error;
    for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
        names.push_back(entry->path().filename());
    std::sort(names.begin(), names.end());
    return names;
}

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

Result<bool> make_folder(const std::filesystem::path& folder) {
    std::error_code reason;
    const bool made = std::filesystem::create_directories(folder, reason);
    if (reason)
        return fail(ErrorCode::outside,
                    fmt::format("{}: cannot be made a folder: {}", folder.string(), reason.message()));
    return made;
}

Result<void> check_spares(std::string_view writer, const std::filesystem::path& out,
                          const std::vector<std::filesystem::path>& inputs) {
    std::error_code absent;  // what is not there is no input
    for (const std::filesystem::path& input : inputs)
        if (std::filesystem::equivalent(out, input, absent))
            return fail(ErrorCode::usage,
                        fmt::format("{} '{}': this file is read, too, and would be lost; expected another", writer,
                                    out.string()));
    return {};
}

}  // namespace skyloop::inline base
