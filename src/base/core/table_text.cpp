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

namespace {

struct ColumnUnit {
    std::string_view name;
    Measured measured;
    double scale;
};

constexpr double unit_foot = 0.3048, unit_knot = 1852.0 / 3600, unit_mile_per_hour = 0.44704,
                 unit_radian = 180 / std::numbers::pi;

using Unit = Measured;
constexpr std::array column_units{ColumnUnit{"s", Unit::time, 1},
                                  ColumnUnit{"sec", Unit::time, 1},
                                  ColumnUnit{"second", Unit::time, 1},
                                  ColumnUnit{"seconds", Unit::time, 1},
                                  ColumnUnit{"ms", Unit::time, 1e-3},
                                  ColumnUnit{"millisecond", Unit::time, 1e-3},
                                  ColumnUnit{"milliseconds", Unit::time, 1e-3},
                                  ColumnUnit{"us", Unit::time, 1e-6},
                                  ColumnUnit{"ns", Unit::time, 1e-9},
                                  ColumnUnit{"utc", Unit::calendar, 1},
                                  ColumnUnit{"deg", Unit::angle, 1},
                                  ColumnUnit{"degree", Unit::angle, 1},
                                  ColumnUnit{"degrees", Unit::angle, 1},
                                  ColumnUnit{"\xC2\xB0", Unit::angle, 1},
                                  ColumnUnit{"rad", Unit::angle, unit_radian},
                                  ColumnUnit{"e7", Unit::angle, 1e-7},
                                  ColumnUnit{"m", Unit::length, 1},
                                  ColumnUnit{"meter", Unit::length, 1},
                                  ColumnUnit{"meters", Unit::length, 1},
                                  ColumnUnit{"metre", Unit::length, 1},
                                  ColumnUnit{"metres", Unit::length, 1},
                                  ColumnUnit{"km", Unit::length, 1000},
                                  ColumnUnit{"cm", Unit::length, 1e-2},
                                  ColumnUnit{"mm", Unit::length, 1e-3},
                                  ColumnUnit{"ft", Unit::length, unit_foot},
                                  ColumnUnit{"feet", Unit::length, unit_foot},
                                  ColumnUnit{"m/s", Unit::speed, 1},
                                  ColumnUnit{"mps", Unit::speed, 1},
                                  ColumnUnit{"km/h", Unit::speed, 1 / 3.6},
                                  ColumnUnit{"kmh", Unit::speed, 1 / 3.6},
                                  ColumnUnit{"kph", Unit::speed, 1 / 3.6},
                                  ColumnUnit{"kn", Unit::speed, unit_knot},
                                  ColumnUnit{"kt", Unit::speed, unit_knot},
                                  ColumnUnit{"knots", Unit::speed, unit_knot},
                                  ColumnUnit{"mph", Unit::speed, unit_mile_per_hour},
                                  ColumnUnit{"ft/s", Unit::speed, unit_foot},
                                  ColumnUnit{"fps", Unit::speed, unit_foot}};

std::string lowered_name(std::string_view text) {
    std::string lower = lower_case(text);
    for (char& letter : lower)
        if (letter == ' ' || letter == '-') letter = '_';
    return lower;
}

std::string without_underscores(std::string_view text) {
    while (text.ends_with('_'))
        text.remove_suffix(1);
    while (text.starts_with('_'))
        text.remove_prefix(1);
    return std::string(text);
}

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
    const auto* const known = std::find_if(column_units.begin(), column_units.end(), [&](const ColumnUnit& one) {
        return one.name == unit && one.measured == measured;
    });
    return known == column_units.end() ? std::nullopt : std::optional(known->scale);
}

}  // namespace skyloop::inline base
