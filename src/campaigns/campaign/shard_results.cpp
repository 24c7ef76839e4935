#include "campaigns/campaign/shard_results.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <set>
#include <utility>
#include <vector>

#include "base/core/files.hpp"
#include "base/core/number_text.hpp"

namespace skyloop::inline campaigns {
namespace {

constexpr std::array<std::string_view, 5> fixed_columns{"key", "number", "seed", "status", "error"};
constexpr std::string_view parameter_prefix = "parameter.", metric_prefix = "metric.", verdict_prefix = "verdict.",
                           detail_prefix = "detail.";
constexpr std::size_t key_digits = 32;

std::string joined_row(const std::vector<std::string>& cells) {
    std::string row;
    for (const std::string& cell : cells)
        row += (row.empty() ? "" : ",") + table_cell(cell);
    return row + "\n";
}

bool is_key(std::string_view text) {
    return text.size() == key_digits && std::all_of(text.begin(), text.end(), [](char c) {
               return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
           });
}

tl::unexpected<Error> bad_cell(std::string_view column, std::string_view found, std::string_view expected) {
    return fail(ErrorCode::input, fmt::format("{}: is '{}'; expected {}", column, found.substr(0, 80), expected));
}

Result<void> parse_fixed_cells(const std::vector<std::string>& cells, RunResult& result) {
    result.key = cells[0];
    if (!is_key(result.key)) return bad_cell("key", cells[0], "32 hexadecimal digits");
    const auto number = number_in<std::uint64_t>(cells[1]), seed = number_in<std::uint64_t>(cells[2]);
    if (!number) return bad_cell("number", cells[1], "a whole number");
    if (!seed) return bad_cell("seed", cells[2], "a whole number");
    result.number = *number;
    result.seed = *seed;
    result.status = cells[3];
    if (result.status != "passed" && result.status != "failed" && result.status != "error")
        return bad_cell("status", cells[3], "passed, failed or error");
    result.error = cells[4];
    return {};
}

}  // namespace

std::string table_cell(std::string_view text) {
    if (text.find_first_of(",\"\n\r") == std::string_view::npos) return std::string(text);
    std::string cell = "\"";
    for (const char c : text) {
        if (c == '"') cell += '"';
        cell += c == '\n' || c == '\r' ? ' ' : c;
    }
    return cell + "\"";
}

std::optional<std::vector<std::string>> table_cells(std::string_view line) {
    std::vector<std::string> cells(1);
    bool quoted = false, closed = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const char c = line[i];
        if (quoted && c == '"') {
            const bool doubled = i + 1 < line.size() && line[i + 1] == '"';
            if (doubled) cells.back() += '"', ++i;
            quoted = doubled;
            closed = !doubled;
        } else if (!quoted && c == ',') {
            cells.emplace_back();
            closed = false;
        } else if (!quoted && c == '"') {
            if (!cells.back().empty() || closed) return std::nullopt;
            quoted = true;
        } else {
            if (closed) return std::nullopt;
            cells.back() += c;
        }
    }
    if (quoted) return std::nullopt;
    return cells;
}

std::string result_header(const ResultColumns& columns) {
    std::vector<std::string> cells(fixed_columns.begin(), fixed_columns.end());
    for (const auto& [prefix, names] : {std::pair{parameter_prefix, &columns.parameters},
                                        {metric_prefix, &columns.metrics},
                                        {verdict_prefix, &columns.verdicts},
                                        {detail_prefix, &columns.verdicts}})
        for (const std::string& name : *names)
            cells.push_back(std::string(prefix) + name);
    return joined_row(cells);
}

std::string result_row(const RunResult& result) {
    std::vector<std::string> cells{result.key, fmt::format("{}", result.number), fmt::format("{}", result.seed),
                                   result.status, result.error};
    cells.insert(cells.end(), result.parameters.begin(), result.parameters.end());
    for (const auto& metric : result.metrics)
        cells.push_back(metric && std::isfinite(*metric) ? fmt::format("{:.7g}", *metric) : "");
    for (const RunVerdict& verdict : result.verdicts)
        cells.push_back(verdict.outcome);
    for (const RunVerdict& verdict : result.verdicts)
        cells.push_back(verdict.detail);
    return joined_row(cells);
}

Result<ResultColumns> parse_result_header(std::string_view line) {
    const auto cells = table_cells(line);
    if (!cells || cells->size() < fixed_columns.size() ||
        !std::equal(fixed_columns.begin(), fixed_columns.end(), cells->begin()))
        return fail(ErrorCode::input, "is no header of results; expected key,number,seed,status,error,…");
    ResultColumns columns;
    std::vector<std::string> details;
    for (std::size_t i = fixed_columns.size(); i < cells->size(); ++i) {
        const std::string_view cell = (*cells)[i];
        bool known = false;
        for (const auto& [prefix, names] : {std::pair{parameter_prefix, &columns.parameters},
                                            {metric_prefix, &columns.metrics},
                                            {verdict_prefix, &columns.verdicts},
                                            {detail_prefix, &details}})
            if (cell.starts_with(prefix)) names->emplace_back(cell.substr(prefix.size())), known = true;
        if (!known) return bad_cell(fmt::format("column {}", i + 1), cell, "parameter, metric, verdict or detail");
    }
    std::set<std::string> seen;
    // The order is that of result_header(), and nothing is there twice.
    const bool twice = std::any_of(cells->begin(), cells->end(), [&](const auto& c) { return !seen.insert(c).second; });
    if (twice || details != columns.verdicts || result_header(columns) != joined_row(*cells))
        return fail(ErrorCode::input,
                    "has its columns in disorder, or twice; expected parameters, metrics, verdicts, "
                    "details");
    return columns;
}

Result<RunResult> parse_result_row(std::string_view line, const ResultColumns& columns) {
    const std::size_t p = columns.parameters.size(), m = columns.metrics.size(), v = columns.verdicts.size();
    const std::size_t expected = fixed_columns.size() + p + m + 2 * v;
    const auto cells = table_cells(line);
    if (!cells) return fail(ErrorCode::input, "has a quotation mark without its other; expected a row of results");
    if (cells->size() != expected)
        return fail(ErrorCode::input, fmt::format("has {} cells; expected {}", cells->size(), expected));
    RunResult result;
    if (const auto parsed = parse_fixed_cells(*cells, result); !parsed) return fail(parsed.error());
    auto at = cells->begin() + static_cast<std::ptrdiff_t>(fixed_columns.size());
    for (std::size_t i = 0; i < p; ++i)
        result.parameters.push_back(*at++);
    for (std::size_t i = 0; i < m; ++i, ++at) {
        const auto value = number_in<double>(*at);
        if (!value && !at->empty()) return bad_cell(columns.metrics[i], *at, "a number or nothing");
        result.metrics.push_back(value);
    }
    for (std::size_t i = 0; i < v; ++i, ++at)
        result.verdicts.push_back({*at, *(at + static_cast<std::ptrdiff_t>(v))});
    return result;
}

namespace {

constexpr std::string_view log_end = ".log.csv";

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
    TableFile file(path, FileDescriptor(::open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666)));
    if (!file.file_.open()) return file.failure("cannot be opened");
    if (const auto begun = file.begin(header); !begun) return fail(begun.error());
    return file;
}

Result<void> TableFile::begin(std::string_view header) {
    const FileLock lock(file_.value());
    const auto end = cut_to_whole_lines();
    if (!end) return fail(end.error());
    if (*end == 0) return write_or_take_back(header, 0);
    std::string first(header.size(), '\0');
    const ssize_t count = ::pread(file_.value(), first.data(), first.size(), 0);
    if (count == static_cast<ssize_t>(header.size()) && first == header) return {};
    return fail(ErrorCode::input,
                fmt::format("{}:1: has other columns than this campaign; expected a folder of its own, or the same "
                            "parameters, metrics and expectations",
                            path_.string()));
}

Result<void> TableFile::append(std::string_view row) {
    const FileLock lock(file_.value());
    // Another process that adds to the file may have been killed amid a row.
    const auto end = cut_to_whole_lines();
    if (!end) return fail(end.error());
    return write_or_take_back(row, *end);
}

// The end of the last whole line, which is the end of the file then.
Result<std::int64_t> TableFile::cut_to_whole_lines() {
    struct stat found {};
    if (::fstat(file_.value(), &found) != 0) return failure("cannot be read");
    const off_t end = end_of_lines(file_.value(), found.st_size);
    if (end != found.st_size && ::ftruncate(file_.value(), end) != 0) return failure("cannot be cut");
    return end;
}

// @param end of the file before
Result<void> TableFile::write_or_take_back(std::string_view text, std::int64_t end) {
    if (write_whole(file_.value(), text)) return {};
    const auto why = failure("cannot be written");
    if (::ftruncate(file_.value(), end) != 0) return why;
    return why;
}

tl::unexpected<Error> TableFile::failure(std::string_view what) const {
    return fail(ErrorCode::outside, fmt::format("{}: {}: {}", path_.string(), what, std::strerror(errno)));
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

}  // namespace skyloop::inline campaigns
