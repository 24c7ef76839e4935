/// Files that a campaign and its engine leave for each other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "base/core/result.hpp"

namespace skyloop::inline campaigns {

/// replace_file(), with the folders of the file where they are missing. The error has the code `outside`.
Result<void> write_engine_file(const std::filesystem::path& path, const std::string& text);

/// The number in a small file, such as an exit code; nothing where there is none, or something else.
std::optional<int> whole_number_of(const std::filesystem::path& file);

/// Counts the results in OUT/shards as they come, reading only what is new since the last look.
class ResultCounter {
public:
    explicit ResultCounter(const std::filesystem::path& out) : shards_(out / "shards") {}
    /// Whole lines below the headers of all *-of-N.csv; a file that became smaller is read again.
    std::size_t look();

private:
    struct Seen {
        std::uintmax_t bytes = 0;
        std::size_t lines = 0;
    };
    static void read_on(const std::filesystem::path& file, std::uintmax_t size, Seen& seen);

    std::filesystem::path shards_;
    std::map<std::filesystem::path, Seen> seen_;
};

}  // namespace skyloop::inline campaigns
