/// Where results are kept: a table for each part of a campaign, DIR/shards/I-of-N.csv.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "base/core/result.hpp"
#include "campaigns/campaign/campaign_plan.hpp"
#include "campaigns/campaign/run_result.hpp"

namespace skyloop {

/// A file that rows are added to, whole or not at all, by several processes if need be (flock). A last line that was
/// cut by a kill or a crash is dropped when the file is opened. State: the file.
class TableFile {
public:
    /// @param header its first line, with its end. Fails with `outside`, or with `input` where the file begins with
    /// another.
    static Result<TableFile> open(const std::filesystem::path& path, std::string_view header);
    TableFile(TableFile&& other) noexcept;
    TableFile& operator=(TableFile&& other) noexcept;
    ~TableFile();

    /// Adds a row with its line end. What a full disk took of it is taken back, and the call fails with `outside`.
    Result<void> append(std::string_view row);
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
    TableFile(std::filesystem::path path, int descriptor) : path_(std::move(path)), descriptor_(descriptor) {}
    Result<void> begin(std::string_view header);

    std::filesystem::path path_;
    int descriptor_ = -1;
};

std::filesystem::path shard_results(const std::filesystem::path& folder, const Shard& shard);  ///< I-of-N.csv
std::filesystem::path shard_log(const std::filesystem::path& folder, const Shard& shard);      ///< I-of-N.log.csv

/// A row as it stands in a file.
struct StoredResult {
    const RunResult& result;
    const ResultColumns& columns;
    const std::filesystem::path& file;
    std::size_t line;
};

/// Shows all results in the tables of a campaign's folder, file by file in the order of their names. A last line
/// without its end is passed over: it is being written, or was cut. `use` fails to end it. Fails with `outside`, with
/// `input` naming file and line, and as `use` does.
Result<void> for_each_result(const std::filesystem::path& folder,
                             const std::function<Result<void>(const StoredResult&)>& use);

}  // namespace skyloop
