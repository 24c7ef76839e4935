/// Numbers that texts are.
/// Numbers as text with a fixed number of decimals or digits, for files and sentences with millions of them.
#pragma once

#include <charconv>
#include <cmath>
#include <concepts>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace skyloop::inline base {

/// The number that a text is as a whole; nothing for an empty text, for one with anything before or behind the number,
/// a plus sign among it, and for a number that the type does not hold. Of floating point numbers infinities and NaN are
/// none.
template <class Number>
std::optional<Number> number_in(std::string_view text) {
    Number number{};
    const char* const end = text.data() + text.size();
    const auto [stopped, error] = std::from_chars(text.data(), end, number);
    if (error != std::errc() || stopped != end) return std::nullopt;
    if constexpr (std::floating_point<Number>)
        if (!std::isfinite(number)) return std::nullopt;
    return number;
}

/// The same, with a plus sign before it or not, as people and tables write numbers.
template <class Number>
std::optional<Number> signed_number_in(std::string_view text) {
    return number_in<Number>(text.substr(text.starts_with('+') ? 1 : 0));
}

/// The number that hexadecimal digits are.
template <std::integral Number>
std::optional<Number> hexadecimal_number_in(std::string_view text) {
    Number number{};
    const char* const end = text.data() + text.size();
    const auto [stopped, error] = std::from_chars(text.data(), end, number, 16);
    return error == std::errc() && stopped == end ? std::optional(number) : std::nullopt;
}

/// Appends `value` with so many decimals, rounded from its exact value (a tie to the even digit), as "%.*f" of C writes
/// it; "nan" and "inf" for what is no number. Takes a quarter of fmt's time.
/// @param decimals 0 to 9
void append_fixed(std::string& text, double value, int decimals);

/// Appends `value` with zeros before it up to so many characters, its sign among them, as fmt's "{:0{}}" does.
void append_padded(std::string& text, int value, int characters);

}  // namespace skyloop::inline base
