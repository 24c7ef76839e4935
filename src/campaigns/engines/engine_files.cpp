#include "campaigns/engines/engine_files.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <system_error>

#include "base/core/files.hpp"
#include "base/core/number_text.hpp"

namespace skyloop::inline campaigns {

Result<void> write_engine_file(const std::filesystem::path& path, const std::string& text) {
    if (const auto made = make_folder(path.parent_path()); !made) return fail(made.error());
    return replace_file(path, text);
}

std::optional<int> whole_number_of(const std::filesystem::path& file) {
    std::ifstream input(file, std::ios::binary);
    std::array<char, 16> bytes{};
    input.read(bytes.data(), bytes.size());
    std::string_view text(bytes.data(), static_cast<std::size_t>(input.gcount()));
    if (text.ends_with('\n')) text.remove_suffix(1);
    return number_in<int>(text);
}

std::size_t ResultCounter::look() {
    std::error_code reason;
    for (std::filesystem::directory_iterator entry(shards_, reason), end; !reason && entry != end;
         entry.increment(reason)) {
        const std::string name = entry->path().filename().string();
        // I-of-N.csv holds results; I-of-N.log.csv tells of the machines.
        if (!name.ends_with(".csv") || name.ends_with(".log.csv") || name.find("-of-") == std::string::npos) continue;
        std::error_code gone;
        const std::uintmax_t size = entry->file_size(gone);
        if (gone) continue;
        read_on(entry->path(), size, seen_[entry->path()]);
    }
    std::size_t results = 0;
    for (const auto& [path, seen] : seen_)
        results += seen.lines > 0 ? seen.lines - 1 : 0;
    return results;
}

void ResultCounter::read_on(const std::filesystem::path& file, std::uintmax_t size, Seen& seen) {
    if (size == seen.bytes) return;
    if (size < seen.bytes) seen = {};
    std::ifstream input(file, std::ios::binary);
    input.seekg(static_cast<std::streamoff>(seen.bytes));
    std::array<char, 65536> bytes{};
    while (input.read(bytes.data(), bytes.size()) || input.gcount() > 0) {
        const auto end = bytes.begin() + input.gcount();
        seen.lines += static_cast<std::size_t>(std::count(bytes.begin(), end, '\n'));
        seen.bytes += static_cast<std::uintmax_t>(input.gcount());
    }
}

}  // namespace skyloop::inline campaigns
