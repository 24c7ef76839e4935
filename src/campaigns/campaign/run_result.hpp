/// What a run of a campaign left, and how tables hold it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"

namespace skyloop {

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

}  // namespace skyloop
