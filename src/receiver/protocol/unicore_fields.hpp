/// Fields of Unicore's logs: each is declared once (field.hpp) with the look that it has in text, and both forms of a
/// log, as text and as bytes, its listing and its reading follow.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/core/number_text.hpp"
#include "receiver/protocol/field_list.hpp"

namespace skyloop::inline receiver {

/// A number with so many digits after the point.
template <FieldText Declared, class Raw, int Decimals = 0>
struct UnicoreNumber : Field<Declared, Raw> {
    static constexpr int decimals = Decimals;
    constexpr UnicoreNumber() = default;
    constexpr UnicoreNumber(Raw number) : Field<Declared, Raw>(number) {}  // NOLINT: converts on purpose
};
/// A number of at least so many hexadecimal digits.
template <FieldText Declared, class Raw, int Digits>
struct UnicoreHex : Field<Declared, Raw> {
    static constexpr int hex_digits = Digits;
    constexpr UnicoreHex() = default;
    constexpr UnicoreHex(Raw number) : Field<Declared, Raw>(number) {}  // NOLINT: converts on purpose
};
/// A number in mantissa and exponent: -4.755795596e-04.
template <FieldText Declared, int Decimals>
struct UnicoreScientific : Field<Declared, double> {
    static constexpr int mantissa_decimals = Decimals;
    constexpr UnicoreScientific() = default;
    constexpr UnicoreScientific(double number) : Field<Declared, double>(number) {}  // NOLINT: converts on purpose
};
/// A number that text has a word for.
struct UnicoreWord {
    std::uint32_t number;
    std::string_view word;
};
template <FieldText Declared, const auto& Words>
struct UnicoreEnum : Field<Declared, std::uint32_t> {
    static constexpr std::span<const UnicoreWord> words{Words};
    constexpr UnicoreEnum() = default;
    constexpr UnicoreEnum(std::uint32_t number) : Field<Declared, std::uint32_t>(number) {}  // NOLINT: on purpose
};
/// A text in quotation marks, of at most Size characters.
template <FieldText Declared, std::size_t Size>
struct UnicoreText : Text<Declared, Size> {
    static constexpr bool quoted = true;
};

/// Fills a fixed text, cut where it is too long.
template <std::size_t Size>
void put_text(std::array<char, Size>& to, std::string_view text) {
    to.fill(0);
    for (std::size_t i = 0; i < std::min(Size, text.size()); ++i)
        to[i] = text[i];
}

namespace unicore_fields {

/// With so many digits after the point, correctly rounded.
std::string fixed_text(double value, int decimals);
/// As mantissa and exponent.
std::string mantissa_text(double value, int decimals);
/// At least so many small hexadecimal digits.
std::string digits_text(std::uint64_t value, int digits);

/// Writes the body of a log as text: fields between commas.
class Writer {
public:
    template <class... T>
    void operator()(const T&... field) {
        (put(field), ...);
    }
    template <class T>
    void rest(const std::vector<T>& list, std::size_t, std::size_t) {
        for (const T& item : list)
            put(item);
    }
    template <class T>
    void counted(const std::vector<T>& list) {
        next() += std::to_string(list.size());
        rest(list, 0, 0);
    }
    [[nodiscard]] std::string take() { return std::move(text_); }

private:
    std::string& next() {
        if (begun_) text_ += ',';
        begun_ = true;
        return text_;
    }
    template <class T>
    void put(const T& field) {
        if constexpr (field_list::Group<T>)
            walk_fields(field, *this);
        else if constexpr (requires { T::quoted; })
            next() += '"' + text_of(field) + '"';
        else if constexpr (requires { field.size(); })
            next() += text_of(field);
        else if constexpr (requires { T::words; })
            next() += word_of(field.raw, T::words);
        else if constexpr (requires { T::hex_digits; })
            next() += digits_text(field.raw, T::hex_digits);
        else if constexpr (requires { T::mantissa_decimals; })
            next() += mantissa_text(field.raw, T::mantissa_decimals);
        else if constexpr (requires { T::decimals; })
            next() += fixed_text(static_cast<double>(field.raw), T::decimals);
        else
            next() += std::to_string(field.raw);
    }
    template <class Characters>
    static std::string text_of(const Characters& characters) {
        std::string text(characters.begin(), characters.end());
        return text.substr(0, text.find('\0'));
    }
    static std::string word_of(std::uint32_t number, std::span<const UnicoreWord> words) {
        for (const UnicoreWord& known : words)
            if (known.number == number) return std::string(known.word);
        return std::to_string(number);
    }

    std::string text_;
    bool begun_ = false;
};

/// Reads such a body back.
class Reader {
public:
    explicit Reader(std::span<const std::string_view> fields) : left_(fields) {}

    template <class... T>
    void operator()(T&... field) {
        (pick(field), ...);
    }
    template <class T>
    void rest(std::vector<T>& list, std::size_t least, std::size_t most) {
        list.clear();
        while (good_ && !left_.empty())
            pick(list.emplace_back());
        if (list.size() < least || list.size() > most) good_ = false;
    }
    template <class T>
    void counted(std::vector<T>& list) {
        const auto count = number_in<std::size_t>(next());
        good_ = good_ && count.has_value();
        list.clear();
        for (std::size_t i = 0; good_ && i < *count; ++i)
            pick(list.emplace_back());
    }
    /// Everything was there, and nothing more.
    [[nodiscard]] bool complete() const { return good_ && left_.empty(); }

private:
    std::string_view next() {
        if (left_.empty()) good_ = false;
        if (!good_) return {};
        const std::string_view field = left_.front();
        left_ = left_.subspan(1);
        return field;
    }
    template <class T>
    void pick(T& field) {
        if constexpr (field_list::Group<T>) {
            walk_fields(field, *this);
        } else if constexpr (requires { T::quoted; }) {
            const std::string_view text = next();
            const bool whole = text.size() >= 2 && text.front() == '"' && text.back() == '"';
            good_ = good_ && whole;
            if (whole) put_text(field, text.substr(1, text.size() - 2));
        } else if constexpr (requires { field.size(); }) {
            put_text(field, next());
        } else if constexpr (requires { T::words; }) {
            read_word(field.raw, T::words);
        } else if constexpr (requires { T::hex_digits; }) {
            keep(hexadecimal_number_in<std::remove_cvref_t<decltype(field.raw)>>(next()), field.raw);
        } else {
            keep(number_in<std::remove_cvref_t<decltype(field.raw)>>(next()), field.raw);
        }
    }
    template <class Raw>
    void keep(std::optional<Raw> number, Raw& to) {
        good_ = good_ && number.has_value();
        if (number) to = *number;
    }
    void read_word(std::uint32_t& to, std::span<const UnicoreWord> words) {
        const std::string_view word = next();
        for (const UnicoreWord& known : words)
            if (known.word == word) {
                to = known.number;
                return;
            }
        keep(number_in<std::uint32_t>(word), to);
    }

    std::span<const std::string_view> left_;
    bool good_ = true;
};

}  // namespace unicore_fields

/// The body of a log as text.
template <class Message>
std::string unicore_body(const Message& message) {
    unicore_fields::Writer writer;
    walk_fields(message, writer);
    return writer.take();
}

/// The log that the fields of a body are; nothing when they are too few, too many or no values of theirs.
template <class Message>
std::optional<Message> read_unicore_body(std::span<const std::string_view> fields) {
    unicore_fields::Reader reader(fields);
    Message message;
    walk_fields(message, reader);
    if (!reader.complete()) return std::nullopt;
    return message;
}

}  // namespace skyloop::inline receiver
