/// A field of a message, declared once: its name, unit, scale and what stands for nothing, beside its form in the
/// bytes.
///
///     I4<"lat_deg*1e-7"> lat;           // a whole number of 1e-7 deg
///     U2<"year"> year;                  // a number as it is
///     I1<"elevation_deg!-91"> elev;     // −91 means that there is none
///     U4<"tow_s*1e-3!4294967295"> tow;  // both
///     I4<"ecef_m*1e-2", 3> ecef;        // three of them
///     Text<"software", 30> sw_version;
///     List<"satellites", NavSatItem> satellites;
///
/// A scale is `*1e-7`, `*4e-2` or `*2^-32`; a name ends with its unit where it has one. A field is the number of the
/// bytes wherever a number is wanted; value() and set() have it in the declared unit. Members that are no fields are
/// written and read, and listed nowhere: reserved bytes, sizes of what follows. A declaration that is none does not
/// compile where it is used.
#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace skyloop::inline receiver {

/// What a declaration says.
struct FieldFormat {
    std::string_view name;
    bool scaled = false;
    double factor = 1, divisor = 1;  ///< a value is number · factor / divisor, which for powers of ten rounds once
    bool can_be_absent = false;
    double absent = 0;  ///< the number that means nothing
};

/// A declaration as an argument of a template.
template <std::size_t Size>
struct FieldText {
    constexpr FieldText(const char (&text)[Size]) {  // NOLINT: converts on purpose
        for (std::size_t i = 0; i < Size; ++i)
            characters[i] = text[i];
    }
    [[nodiscard]] constexpr std::string_view view() const { return {characters, Size - 1}; }
    char characters[Size]{};
};

namespace field_text {

// Digits off the front of the text.
constexpr double digits(std::string_view& text) {
    if (text.empty() || text[0] < '0' || text[0] > '9') throw "a field's declaration: digits are missing";
    double number = 0;
    for (; !text.empty() && text[0] >= '0' && text[0] <= '9'; text.remove_prefix(1))
        number = number * 10 + (text[0] - '0');
    return number;
}

constexpr double power(double base, double exponent) {
    double product = 1;
    for (; exponent > 0; --exponent)
        product *= base;
    return product;
}

constexpr bool take(std::string_view& text, std::string_view word) {
    if (!text.starts_with(word)) return false;
    text.remove_prefix(word.size());
    return true;
}

constexpr bool is_name(char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; }

}  // namespace field_text

/// Reads a declaration; one that is none is no constant.
constexpr FieldFormat field_format(std::string_view text) {
    std::size_t length = 0;
    while (length < text.size() && field_text::is_name(text[length]))
        ++length;
    FieldFormat format;
    format.name = text.substr(0, length);
    if (format.name.empty()) throw "a field's declaration: its name is missing";
    text.remove_prefix(length);
    if (field_text::take(text, "*")) {
        format.scaled = true;
        if (field_text::take(text, "2^-")) {
            format.divisor = field_text::power(2, field_text::digits(text));
        } else {
            format.factor = field_text::digits(text);
            if (!field_text::take(text, "e-")) throw "a field's declaration: a scale is 1e-7 or 2^-32";
            format.divisor = field_text::power(10, field_text::digits(text));
        }
    }
    if (field_text::take(text, "!")) {
        const double sign = field_text::take(text, "-") ? -1 : 1;
        format.can_be_absent = true;
        format.absent = sign * field_text::digits(text);
        if (field_text::take(text, "e")) format.absent *= field_text::power(10, field_text::digits(text));
    }
    if (!text.empty()) throw "a field's declaration: more than name, scale and absence";
    return format;
}

/// The number that a field of this type holds for a value: the nearest one, a whole one without a fraction; that of not
/// a number is 0.
template <class Raw>
Raw nearest(double value) {
    using Limits = std::numeric_limits<Raw>;
    if constexpr (std::is_floating_point_v<Raw>) {
        return static_cast<Raw>(value);
    } else {
        if (std::isnan(value)) return 0;
        const double whole = std::round(value);
        if (whole <= static_cast<double>(Limits::min())) return Limits::min();
        if (whole >= static_cast<double>(Limits::max())) return Limits::max();
        return static_cast<Raw>(whole);
    }
}

/// A number of the bytes that is one of C++, too.
template <class Raw>
struct RawNumber {
    using raw_type = Raw;

    constexpr RawNumber() = default;
    constexpr RawNumber(Raw number) : raw(number) {}       // NOLINT: converts on purpose
    constexpr operator Raw&() { return raw; }              // NOLINT
    constexpr operator const Raw&() const { return raw; }  // NOLINT
    template <class Bits>
    constexpr void operator|=(Bits bits) {
        raw = static_cast<Raw>(raw | static_cast<Raw>(bits));
    }
    template <class Bits>
    constexpr void operator&=(Bits bits) {
        raw = static_cast<Raw>(raw & static_cast<Raw>(bits));
    }

    Raw raw{};
};

/// What a number means by a declaration: a value, or of what can be absent perhaps none.
template <class Declaration>
constexpr auto declared_value(double number) {
    constexpr FieldFormat format = Declaration::format;
    const double value = number * format.factor / format.divisor;
    if constexpr (format.can_be_absent)
        return number == format.absent ? std::nullopt : std::optional(value);
    else
        return value;
}

/// One number, or an array of them.
template <FieldText Declared, class Raw, std::size_t Count = 1>
struct Field : std::array<Raw, Count> {
    static constexpr FieldFormat format = field_format(Declared.view());

    constexpr Field() : std::array<Raw, Count>{} {}
    constexpr Field(const std::array<Raw, Count>& numbers) : std::array<Raw, Count>(numbers) {}  // NOLINT
    template <std::convertible_to<Raw>... Number>
    requires(sizeof...(Number) > 1 && sizeof...(Number) <= Count) constexpr Field(Number... number)  // NOLINT
        : std::array<Raw, Count>{static_cast<Raw>(number)...} {}
    /// In the declared unit; of numbers that can be absent nothing, if this one is.
    [[nodiscard]] constexpr auto value(std::size_t i) const {
        return declared_value<Field>(static_cast<double>((*this)[i]));
    }
    /// The nearest number to a value in the declared unit.
    void set(std::size_t i, double value) { (*this)[i] = nearest<Raw>(value * format.divisor / format.factor); }
};

template <FieldText Declared, class Raw>
struct Field<Declared, Raw, 1> : RawNumber<Raw> {
    static constexpr FieldFormat format = field_format(Declared.view());

    using RawNumber<Raw>::RawNumber;
    constexpr Field& operator=(Raw number) {
        this->raw = number;
        return *this;
    }
    /// In the declared unit; of a field that can be absent nothing, if it is.
    [[nodiscard]] constexpr auto value() const { return declared_value<Field>(static_cast<double>(this->raw)); }
    /// The nearest number to a value in the declared unit. Where the largest or the least number stands for nothing, a
    /// value beyond the range is the one beside it.
    void set(double value) {
        using Limits = std::numeric_limits<Raw>;
        this->raw = nearest<Raw>(value * format.divisor / format.factor);
        if constexpr (std::is_integral_v<Raw> && format.can_be_absent && format.absent != 0) {
            if (this->raw == format.absent && this->raw == Limits::max()) --this->raw;
            if (this->raw == format.absent && this->raw == Limits::min()) ++this->raw;
        }
    }
};

/// As many as the message says or has.
template <FieldText Declared, class Item>
struct List : std::vector<Item> {
    static constexpr FieldFormat format = field_format(Declared.view());

    using std::vector<Item>::vector;
    using std::vector<Item>::operator=;
    List() = default;
    List(std::vector<Item> items) : std::vector<Item>(std::move(items)) {}  // NOLINT: converts on purpose
};

// The types of numbers, as u-blox's documents call them.
// clang-format off
template <FieldText Declared, std::size_t Count = 1> using U1 = Field<Declared, std::uint8_t, Count>;
template <FieldText Declared, std::size_t Count = 1> using U2 = Field<Declared, std::uint16_t, Count>;
template <FieldText Declared, std::size_t Count = 1> using U4 = Field<Declared, std::uint32_t, Count>;
template <FieldText Declared, std::size_t Count = 1> using U8 = Field<Declared, std::uint64_t, Count>;
template <FieldText Declared, std::size_t Count = 1> using I1 = Field<Declared, std::int8_t, Count>;
template <FieldText Declared, std::size_t Count = 1> using I2 = Field<Declared, std::int16_t, Count>;
template <FieldText Declared, std::size_t Count = 1> using I4 = Field<Declared, std::int32_t, Count>;
template <FieldText Declared, std::size_t Count = 1> using R4 = Field<Declared, float, Count>;
template <FieldText Declared, std::size_t Count = 1> using R8 = Field<Declared, double, Count>;
template <FieldText Declared, std::size_t Count> using Text = Field<Declared, char, Count>;
// clang-format on

/// A member that is declared as one.
template <class T>
concept DeclaredField = requires {
    T::format;
};

}  // namespace skyloop::inline receiver
