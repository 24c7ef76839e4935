#include "base/core/column_name.hpp"
#include "base/core/letter_case.hpp"

#include <algorithm>
#include <array>
#include <numbers>

#include "base/core/table_line.hpp"

namespace skyloop {
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

}  // namespace skyloop
