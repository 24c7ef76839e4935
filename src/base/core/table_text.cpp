#include "base/core/table_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>

#include "base/core/words.hpp"

namespace skyloop::inline base {
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

std::string_view trimmed_cell(std::string_view text) { return trimmed(text, " \t\r\n\""); }

bool is_absent(std::string_view cell) { return cell.empty() || cell == "nan" || cell == "NaN" || cell == "NAN"; }

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

namespace {

struct ColumnUnit {
    Measured measured;
    double scale;
    std::array<std::string_view, 5> names;
};

constexpr double unit_foot = 0.3048, unit_knot = 1852.0 / 3600, unit_mile_per_hour = 0.44704,
                 unit_radian = 180 / std::numbers::pi;

constexpr std::array column_units{ColumnUnit{Measured::time, 1, {"s", "sec", "second", "seconds"}},
                                  ColumnUnit{Measured::time, 1e-3, {"ms", "millisecond", "milliseconds"}},
                                  ColumnUnit{Measured::time, 1e-6, {"us"}},
                                  ColumnUnit{Measured::time, 1e-9, {"ns"}},
                                  ColumnUnit{Measured::calendar, 1, {"utc"}},
                                  ColumnUnit{Measured::angle, 1, {"deg", "degree", "degrees", "\xC2\xB0"}},
                                  ColumnUnit{Measured::angle, unit_radian, {"rad"}},
                                  ColumnUnit{Measured::angle, 1e-7, {"e7"}},
                                  ColumnUnit{Measured::length, 1, {"m", "meter", "meters", "metre", "metres"}},
                                  ColumnUnit{Measured::length, 1000, {"km"}},
                                  ColumnUnit{Measured::length, 1e-2, {"cm"}},
                                  ColumnUnit{Measured::length, 1e-3, {"mm"}},
                                  ColumnUnit{Measured::length, unit_foot, {"ft", "feet"}},
                                  ColumnUnit{Measured::speed, 1, {"m/s", "mps"}},
                                  ColumnUnit{Measured::speed, 1 / 3.6, {"km/h", "kmh", "kph"}},
                                  ColumnUnit{Measured::speed, unit_knot, {"kn", "kt", "knots"}},
                                  ColumnUnit{Measured::speed, unit_mile_per_hour, {"mph"}},
                                  ColumnUnit{Measured::speed, unit_foot, {"ft/s", "fps"}}};

std::string lowered_name(std::string_view text) {
    std::string lower = lower_case(text);
    for (char& letter : lower)
        if (letter == ' ' || letter == '-') letter = '_';
    return lower;
}

std::string without_underscores(std::string_view text) { return std::string(trimmed(text, "_")); }

}  // namespace

ColumnName bracketed_column_name(std::string_view text) {
    const std::string lower = lowered_name(text);
    const std::size_t open = lower.find_first_of("([");
    if (open == std::string::npos) return {without_underscores(lower), {}};
    const std::size_t close = std::min(lower.find_first_of(")]", open), lower.size());
    return {without_underscores(std::string_view(lower).substr(0, open)),
            without_underscores(std::string_view(lower).substr(open + 1, close - open - 1))};
}

ColumnName column_name(std::string_view text) {
    ColumnName whole = bracketed_column_name(text);
    const std::size_t last = whole.name.rfind('_');
    if (!whole.unit.empty() || last == std::string::npos) return whole;
    return {without_underscores(std::string_view(whole.name).substr(0, last)), whole.name.substr(last + 1)};
}

std::optional<double> unit_scale(std::string_view unit, Measured measured) {
    if (unit.empty()) return std::nullopt;
    for (const ColumnUnit& known : column_units)
        if (known.measured == measured && std::find(known.names.begin(), known.names.end(), unit) != known.names.end())
            return known.scale;
    return std::nullopt;
}

}  // namespace skyloop::inline base
