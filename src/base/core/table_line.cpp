#include "base/core/table_line.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace skyloop {
namespace {

// Of the first cell; npos: it is the last one.
std::size_t end_of_cell(std::string_view line, std::string_view separators) {
    const std::size_t begin = std::min(line.find_first_not_of(" \t"), line.size());
    const bool in_quotes = begin < line.size() && line[begin] == '"';
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (in_quotes && line[i] == '"') quoted = !quoted;
        if (!quoted && separators.find(line[i]) != std::string_view::npos) return i;
    }
    return quoted ? line.find_first_of(separators) : std::string_view::npos;
}

}  // namespace

std::string_view trimmed_cell(std::string_view text) {
    constexpr std::string_view around = " \t\r\n\"";
    const std::size_t first = text.find_first_not_of(around);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(around) - first + 1);
}

char separator_in(std::string_view line) {
    for (const char candidate : {',', ';', '\t'})
        if (line.find(candidate) != std::string_view::npos) return candidate;
    return ' ';
}

void split_line(std::string_view line, std::string_view separators, bool runs, LineCells& cells) {
    cells.clear();
    for (;;) {
        const std::size_t end = end_of_cell(line, separators);
        cells.push_back(trimmed_cell(line.substr(0, end)));
        if (end == std::string_view::npos) return;
        line.remove_prefix(end + 1);
        if (runs) line.remove_prefix(std::min(line.find_first_not_of(separators), line.size()));
    }
}

void split_table_line(std::string_view line, char separator, LineCells& cells) {
    if (separator != ' ') return split_line(line, {&separator, 1}, false, cells);
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    split_line(line.substr(0, line.find_last_not_of(" \t\r") + 1), " \t", true, cells);
}

std::optional<std::string> width_mistake(const LineCells& cells, std::size_t names) {
    std::size_t count = cells.size();
    while (count > names && cells[count - 1].empty())
        --count;
    if (count <= names) return std::nullopt;
    return fmt::format(
        "{} cells under {} names; expected one for each: numbers with a decimal point, texts that hold the separator "
        "in quotes",
        count, names);
}

}  // namespace skyloop
