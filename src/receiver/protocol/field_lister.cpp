#include "receiver/protocol/field_lister.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace skyloop::inline receiver {
namespace {

template <class Raw>
DecodedValue value_of(Raw raw, const FieldFormat& format) {
    const auto number = static_cast<double>(raw);
    if (format.can_be_absent && number == format.absent) return {};
    if (format.scaled) return {number * format.factor / format.divisor};
    return {raw};
}

}  // namespace

DecodedValue scaled_value(std::uint64_t raw, const FieldFormat& format) { return value_of(raw, format); }
DecodedValue scaled_value(std::int64_t raw, const FieldFormat& format) { return value_of(raw, format); }
DecodedValue scaled_value(double raw, const FieldFormat& format) { return value_of(raw, format); }

double shortest(float value) {
    if (!std::isfinite(value)) return static_cast<double>(value);
    return std::strtod(fmt::format("{}", value).c_str(), nullptr);
}

DecodedValue text_value(std::string_view characters) {
    return {std::string(characters.substr(0, std::min(characters.find('\0'), characters.size())))};
}

}  // namespace skyloop::inline receiver
