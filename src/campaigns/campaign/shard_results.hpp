/// What a run of a campaign left, and how tables hold it.
/// Where results are kept: a table for each part of a campaign, DIR/shards/I-of-N.csv.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/file_descriptor.hpp"
#include "base/core/result.hpp"
#include "campaigns/campaign/campaign_plan.hpp"

namespace skyloop::inline campaigns {

/// What became of one expectation.
struct RunVerdict {
    std::string outcome;  ///< "passed", "failed", "undecided", "not run"; empty: the run did not come so far
    std::string detail;   ///< a sentence
    bool operator==(const RunVerdict&) const = default;
};

struct RunResult {
    std::string key;
    std::uint64_t number = 0, seed = 0;
    std::string status;                            ///< "passed", "failed", "error"
    std::string error;                             ///< why the scenario cannot be run so; else empty
    std::vector<std::string> parameters{};         ///< values as people read them
    std::vector<std::optional<double>> metrics{};  ///< nothing: there is none
    std::vector<RunVerdict> verdicts{};
    bool operator==(const RunResult&) const = default;
};

/// Names of what each row of a table holds beside key, number, seed, status and error.
struct ResultColumns {
    std::vector<std::string> parameters, metrics, verdicts;
    bool operator==(const ResultColumns&) const = default;
};

/// Comma-separated values (RFC 4180, without line ends within cells, which become blanks), each with its line end. Of
/// numbers 7 significant digits, so that the last bits of a C library's functions do not show.
std::string result_header(const ResultColumns& columns);
std::string result_row(const RunResult& result);

/// Fails with `input`: a sentence without file and line.
Result<ResultColumns> parse_result_header(std::string_view line);
Result<RunResult> parse_result_row(std::string_view line, const ResultColumns& columns);

/// A cell of such a table, quoted where it must be.
std::string table_cell(std::string_view text);
/// The cells of a line; nothing where a quotation mark is not closed, or stands amid a cell.
std::optional<std::vector<std::string>> table_cells(std::string_view line);

/// A file that rows are added to, whole or not at all, by several processes if need be (flock). A last line that was
/// cut by a kill or a crash is dropped when the file is opened. State: the file.
class TableFile {
public:
    /// @param header its first line, with its end. Fails with `outside`, or with `input` where the file begins with
    /// another.
    static Result<TableFile> open(const std::filesystem::path& path, std::string_view header);

    /// Adds a row with its line end. What a full disk took of it is taken back, and the call fails with `outside`.
    Result<void> append(std::string_view row);
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
    TableFile(std::filesystem::path path, FileDescriptor file) : path_(std::move(path)), file_(std::move(file)) {}
    Result<void> begin(std::string_view header);
    Result<std::int64_t> cut_to_whole_lines();
    Result<void> write_or_take_back(std::string_view text, std::int64_t end);
    [[nodiscard]] tl::unexpected<Error> failure(std::string_view what) const;

    std::filesystem::path path_;
    FileDescriptor file_;
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

}  // namespace skyloop::inline campaigns
