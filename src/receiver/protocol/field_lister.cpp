#include "receiver/protocol/field_lister.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>

namespace skyloop::inline receiver {
namespace {

int digits_of_scale(std::string_view text) {
    int digits = 0;
    std::from_chars(text.data(), text.data() + text.size(), digits);
    return digits;
}

// Where the name that begins here ends: at a space outside brackets.
std::size_t end_of_name(std::string_view names) {
    int depth = 0;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (names[i] == '[') ++depth;
        if (names[i] == ']') --depth;
        if (names[i] == ' ' && depth == 0) return i;
    }
    return names.size();
}

double tenth_power(int digits) {
    double power = 1;
    for (int i = 0; i < digits; ++i)
        power *= 10;
    return power;
}

// Division by a power of ten rounds once, so that the shortest text is the decimal number itself.
template <class Raw>
DecodedValue value_of(Raw raw, const FieldName& name) {
    const auto number = static_cast<double>(raw);
    if (name.absent && number == *name.absent) return {};
    if (name.decimal_digits != 0) return {number * name.factor / tenth_power(name.decimal_digits)};
    if (name.binary_digits != 0) return {std::ldexp(number, -name.binary_digits)};
    return {raw};
}

}  // namespace

FieldName next_field_name(std::string_view& names) {
    names.remove_prefix(std::min(names.find_first_not_of(' '), names.size()));
    std::string_view word = names.substr(0, end_of_name(names));
    names.remove_prefix(word.size());
    names.remove_prefix(std::min(names.find_first_not_of(' '), names.size()));
    FieldName name;
    if (const std::size_t bracket = word.find('['); bracket != word.npos) {
        name.items = word.substr(bracket + 1, word.size() - bracket - 2);
        word = word.substr(0, bracket);
    }
    if (const std::size_t mark = word.find('!'); mark != word.npos) {
        name.absent = std::strtod(std::string(word.substr(mark + 1)).c_str(), nullptr);
        word = word.substr(0, mark);
    }
    if (const std::size_t star = word.find('*'); star != word.npos) {
        const std::string_view scale = word.substr(star + 1);
        if (scale.starts_with("2^-")) {
            name.binary_digits = digits_of_scale(scale.substr(3));
        } else {
            name.factor = scale[0] - '0';
            name.decimal_digits = digits_of_scale(scale.substr(3));
        }
        word = word.substr(0, star);
    }
    name.hidden = word.starts_with('-');
    name.name = name.hidden ? word.substr(1) : word;
    return name;
}

DecodedValue scaled_value(std::uint64_t raw, const FieldName& name) { return value_of(raw, name); }
DecodedValue scaled_value(std::int64_t raw, const FieldName& name) { return value_of(raw, name); }
DecodedValue scaled_value(double raw, const FieldName& name) { return value_of(raw, name); }

double shortest(float value) {
    if (!std::isfinite(value)) return static_cast<double>(value);
    return std::strtod(fmt::format("{}", value).c_str(), nullptr);
}

DecodedValue text_value(std::string_view characters) {
    return {std::string(characters.substr(0, std::min(characters.find('\0'), characters.size())))};
}

}  // namespace skyloop::inline receiver
