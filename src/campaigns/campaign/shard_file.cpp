#include "campaigns/campaign/shard_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>
#include <vector>

#include "base/core/make_folder.hpp"
#include "base/core/text_file.hpp"

namespace skyloop {
namespace {

constexpr std::string_view log_end = ".log.csv";

tl::unexpected<Error> table_failure(const std::filesystem::path& path, std::string_view what) {
    return fail(ErrorCode::outside, fmt::format("{}: {}: {}", path.string(), what, std::strerror(errno)));
}

// Held while a row is written.
class FileLock {
public:
    explicit FileLock(int descriptor) : descriptor_(descriptor) {
        while (::flock(descriptor, LOCK_EX) != 0 && errno == EINTR) {
        }
    }
    ~FileLock() { ::flock(descriptor_, LOCK_UN); }
    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;

private:
    int descriptor_;
};

bool write_whole(int descriptor, std::string_view text) {
    while (!text.empty()) {
        const ssize_t count = ::write(descriptor, text.data(), text.size());
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return false;
        text.remove_prefix(static_cast<std::size_t>(count));
    }
    return true;
}

// Where the last whole line ends.
off_t end_of_lines(int descriptor, off_t size) {
    constexpr off_t piece_size = 4096;
    while (size > 0) {
        char piece[piece_size];
        const off_t from = std::max<off_t>(0, size - piece_size);
        const ssize_t count = ::pread(descriptor, piece, static_cast<std::size_t>(size - from), from);
        if (count <= 0) return size;
        for (ssize_t i = count; i > 0; --i)
            if (piece[i - 1] == '\n') return from + i;
        size = from;
    }
    return 0;
}

std::string shard_name(const Shard& shard) { return fmt::format("{}-of-{}", shard.index, shard.count); }

Result<std::vector<std::filesystem::path>> tables_in(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    std::error_code none;
    const std::filesystem::path shards = folder / "shards";
    if (!std::filesystem::exists(shards, none)) return files;
    for (auto at = std::filesystem::directory_iterator(shards, none);
         !none && at != std::filesystem::directory_iterator(); at.increment(none)) {
        const std::string name = at->path().filename().string();
        if (name.ends_with(".csv") && !name.ends_with(log_end)) files.push_back(at->path());
    }
    if (none) return fail(ErrorCode::outside, fmt::format("{}: cannot be read: {}", shards.string(), none.message()));
    std::sort(files.begin(), files.end());
    return files;
}

Result<void> show_rows(const std::filesystem::path& file, std::string_view text,
                       const std::function<Result<void>(const StoredResult&)>& use) {
    ResultColumns columns;
    for (std::size_t line = 1; !text.empty(); ++line) {
        const std::size_t end = text.find('\n');
        if (end == std::string_view::npos) return {};
        const std::string_view row = text.substr(0, end);
        text.remove_prefix(end + 1);
        const auto at_line = [&](const Error& error) {
            return fail(error.code, fmt::format("{}:{}: {}", file.string(), line, error.message));
        };
        if (line == 1) {
            auto header = parse_result_header(row);
            if (!header) return at_line(header.error());
            columns = std::move(*header);
            continue;
        }
        const auto result = parse_result_row(row, columns);
        if (!result) return at_line(result.error());
        if (const auto used = use({*result, columns, file, line}); !used) return fail(used.error());
    }
    return {};
}

}  // namespace

Result<TableFile> TableFile::open(const std::filesystem::path& path, std::string_view header) {
    if (const auto made = make_folder(path.parent_path()); !made) return fail(made.error());
    const int descriptor = ::open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (descriptor < 0) return table_failure(path, "cannot be opened");
    TableFile file(path, descriptor);
    if (const auto begun = file.begin(header); !begun) return fail(begun.error());
    return file;
}

Result<void> TableFile::begin(std::string_view header) {
    const FileLock lock(descriptor_);
    struct stat found {};
    if (::fstat(descriptor_, &found) != 0) return table_failure(path_, "cannot be read");
    const off_t end = end_of_lines(descriptor_, found.st_size);
    if (end != found.st_size && ::ftruncate(descriptor_, end) != 0) return table_failure(path_, "cannot be cut");
    if (end == 0) {
        if (write_whole(descriptor_, header)) return {};
        const auto failure = table_failure(path_, "cannot be written");
        if (::ftruncate(descriptor_, 0) != 0) return failure;
        return failure;
    }
    std::string first(header.size(), '\0');
    const ssize_t count = ::pread(descriptor_, first.data(), first.size(), 0);
    if (count == static_cast<ssize_t>(header.size()) && first == header) return {};
    return fail(ErrorCode::input,
                fmt::format("{}:1: has other columns than this campaign; expected a folder of its own, or the same "
                            "parameters, metrics and expectations",
                            path_.string()));
}

TableFile::TableFile(TableFile&& other) noexcept
    : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

TableFile& TableFile::operator=(TableFile&& other) noexcept {
    std::swap(path_, other.path_);
    std::swap(descriptor_, other.descriptor_);
    return *this;
}

TableFile::~TableFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

Result<void> TableFile::append(std::string_view row) {
    const FileLock lock(descriptor_);
    struct stat found {};
    if (::fstat(descriptor_, &found) != 0) return table_failure(path_, "cannot be read");
    // Another process that adds to the file may have been killed amid a row.
    const off_t end = end_of_lines(descriptor_, found.st_size);
    if (end != found.st_size && ::ftruncate(descriptor_, end) != 0) return table_failure(path_, "cannot be cut");
    if (write_whole(descriptor_, row)) return {};
    const auto failure = table_failure(path_, "cannot be written");
    if (::ftruncate(descriptor_, end) != 0) return failure;
    return failure;
}

std::filesystem::path shard_results(const std::filesystem::path& folder, const Shard& shard) {
    return folder / "shards" / (shard_name(shard) + ".csv");
}

std::filesystem::path shard_log(const std::filesystem::path& folder, const Shard& shard) {
    return folder / "shards" / (shard_name(shard) + std::string(log_end));
}

Result<void> for_each_result(const std::filesystem::path& folder,
                             const std::function<Result<void>(const StoredResult&)>& use) {
    const auto files = tables_in(folder);
    if (!files) return fail(files.error());
    constexpr std::size_t largest = std::size_t{4} << 30;  // of a million runs with some thousand bytes each
    for (const auto& file : *files) {
        const auto text = read_text_file(file, largest);
        if (!text) return fail(text.error());
        if (const auto shown = show_rows(file, *text, use); !shown) return fail(shown.error());
    }
    return {};
}

}  // namespace skyloop
