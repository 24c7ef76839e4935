#include "campaigns/campaign/run_result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <set>

namespace skyloop {
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

template <class Number>
bool parse_cell(std::string_view cell, Number& number) {
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), number);
    return error == std::errc() && end == cell.data() + cell.size();
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
    if (!parse_cell(cells[1], result.number)) return bad_cell("number", cells[1], "a whole number");
    if (!parse_cell(cells[2], result.seed)) return bad_cell("seed", cells[2], "a whole number");
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
        double value = 0;
        if (!at->empty() && (!parse_cell(*at, value) || !std::isfinite(value)))
            return bad_cell(columns.metrics[i], *at, "a number or nothing");
        result.metrics.push_back(at->empty() ? std::nullopt : std::optional(value));
    }
    for (std::size_t i = 0; i < v; ++i, ++at)
        result.verdicts.push_back({*at, *(at + static_cast<std::ptrdiff_t>(v))});
    return result;
}

}  // namespace skyloop
