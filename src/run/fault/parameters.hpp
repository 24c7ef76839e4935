/// What a fault or a command is told: named values, checked against a table that also makes the documentation.
#pragma once

#include <array>
#include <initializer_list>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/core/result.hpp"
#include "base/geo/geodetic.hpp"
#include "run/fault/receiver_needs.hpp"

namespace skyloop::inline run {

/// A value as scenario files, control messages and the command line give it.
using ParameterValue = std::variant<double, bool, std::string, std::vector<double>, std::vector<std::string>>;

/// Values by name.
using ParameterMap = std::map<std::string, ParameterValue, std::less<>>;

/// What kind of value a parameter takes.
enum class ParameterType {
    number,
    whole_number,
    flag,   ///< true or false
    word,   ///< one of a few
    words,  ///< a list of some of a few; a single one may stand alone
    text,
    texts,   ///< a list of texts; a single one may stand alone
    numbers  ///< a list of numbers
};

/// What a parameter is when it is not given; nothing: it is then no_standard. A list is always no_standard.
using ParameterStandard = std::variant<std::monostate, double, bool, std::string_view>;

/// One parameter: how it is called, with its unit, and what it takes. Its texts live as long as the program.
struct ParameterSpec {
    static constexpr double unlimited = std::numeric_limits<double>::max();
    static constexpr std::size_t any_count = std::numeric_limits<std::size_t>::max();

    std::string_view name{};
    ParameterType type = ParameterType::number;
    std::string_view meaning{};  ///< for people, half a sentence
    ParameterStandard standard{};
    bool needed = false;                                  ///< it must be given
    double least = -unlimited, most = unlimited;          ///< of numbers
    std::size_t count_least = 0, count_most = any_count;  ///< of lists
    std::span<const std::string_view> choices{};          ///< of `word` and `words`
    const ReceiverNeed* need = nullptr;                   ///< of a receiver where it differs from its standard
    IdleValue idle_value = nullptr;  ///< of each word or text; where all of them are idle, so is the whole fault

    [[nodiscard]] std::optional<ParameterValue> standard_value() const;

    /// The same, absent unless given.
    [[nodiscard]] constexpr ParameterSpec without_standard() const {
        ParameterSpec spec = *this;
        spec.standard = {};
        return spec;
    }
    /// The same, one that must be given.
    [[nodiscard]] constexpr ParameterSpec that_is_needed() const {
        ParameterSpec spec = without_standard();
        spec.needed = true;
        return spec;
    }
    /// The same, of which nothing comes at a receiver that lacks this.
    [[nodiscard]] constexpr ParameterSpec that_needs(const ReceiverNeed& of_receiver) const {
        ParameterSpec spec = *this;
        spec.need = &of_receiver;
        return spec;
    }
    /// The same, of whose values this says which come to nothing.
    [[nodiscard]] constexpr ParameterSpec judged_by(IdleValue judge) const {
        ParameterSpec spec = *this;
        spec.idle_value = judge;
        return spec;
    }
};

/// No standard: the parameter is absent unless given.
inline constexpr std::nullopt_t no_standard = std::nullopt;

// Tables of parameters are written with these.
constexpr ParameterSpec number_parameter(std::string_view name, std::optional<double> standard, double least,
                                         double most, std::string_view meaning) {
    return {.name = name,
            .meaning = meaning,
            .standard = standard ? ParameterStandard(*standard) : ParameterStandard(),
            .least = least,
            .most = most};
}
constexpr ParameterSpec whole_number_parameter(std::string_view name, std::optional<double> standard, double least,
                                               double most, std::string_view meaning) {
    ParameterSpec spec = number_parameter(name, standard, least, most, meaning);
    spec.type = ParameterType::whole_number;
    return spec;
}
constexpr ParameterSpec needed_number(std::string_view name, double least, double most, std::string_view meaning) {
    return number_parameter(name, no_standard, least, most, meaning).that_is_needed();
}
constexpr ParameterSpec flag_parameter(std::string_view name, bool standard, std::string_view meaning) {
    return {.name = name, .type = ParameterType::flag, .meaning = meaning, .standard = standard};
}
constexpr ParameterSpec text_parameter(std::string_view name, std::string_view standard, std::string_view meaning) {
    return {.name = name, .type = ParameterType::text, .meaning = meaning, .standard = standard};
}
constexpr ParameterSpec texts_parameter(std::string_view name, std::string_view meaning) {
    return {.name = name, .type = ParameterType::texts, .meaning = meaning, .count_least = 1};
}
/// @param choices live as long as the program
constexpr ParameterSpec word_parameter(std::string_view name, std::string_view standard,
                                       std::span<const std::string_view> choices, std::string_view meaning) {
    return {.name = name, .type = ParameterType::word, .meaning = meaning, .standard = standard, .choices = choices};
}
constexpr ParameterSpec words_parameter(std::string_view name, std::span<const std::string_view> choices,
                                        std::string_view meaning) {
    return {.name = name, .type = ParameterType::words, .meaning = meaning, .count_least = 1, .choices = choices};
}
/// A list of so many numbers.
constexpr ParameterSpec numbers_parameter(std::string_view name, std::size_t count, double least, double most,
                                          std::string_view meaning) {
    return {.name = name,
            .type = ParameterType::numbers,
            .meaning = meaning,
            .least = least,
            .most = most,
            .count_least = count,
            .count_most = count};
}
/// [latitude, longitude] or [latitude, longitude, height]: degrees, metres above the ellipsoid.
constexpr ParameterSpec place_parameter(std::string_view name, std::string_view meaning) {
    return {.name = name, .type = ParameterType::numbers, .meaning = meaning, .count_least = 2, .count_most = 3};
}
/// A list of at least three pairs of latitude and longitude, degrees, flat or pair by pair.
constexpr ParameterSpec polygon_parameter(std::string_view name, std::string_view meaning) {
    return {
        .name = name, .type = ParameterType::numbers, .meaning = meaning, .least = -360, .most = 360, .count_least = 6};
}

/// The parameters of one fault or command, as constant data.
class ParameterList {
public:
    constexpr ParameterList(std::initializer_list<ParameterSpec> specs) {
        for (const ParameterSpec& spec : specs)
            specs_[count_++] = spec;
    }
    [[nodiscard]] constexpr const ParameterSpec* begin() const { return specs_.data(); }
    [[nodiscard]] constexpr const ParameterSpec* end() const { return specs_.data() + count_; }
    constexpr operator std::span<const ParameterSpec>() const { return {specs_.data(), count_}; }

    friend constexpr ParameterList operator+(ParameterList first, const ParameterList& second) {
        for (const ParameterSpec& spec : second)
            first.specs_[first.count_++] = spec;
        return first;
    }

private:
    std::array<ParameterSpec, 16> specs_{};
    std::size_t count_ = 0;
};

/// Values that have been checked: every one that has a standard is there.
///
/// Asking for a parameter that its table does not have, or by the wrong type, is a mistake of the program.
class Parameters {
public:
    Parameters() = default;
    explicit Parameters(ParameterMap values) : values_(std::move(values)) {}

    [[nodiscard]] bool has(std::string_view name) const { return values_.contains(name); }
    [[nodiscard]] double number(std::string_view name) const;
    /// Nothing when it was not given.
    [[nodiscard]] std::optional<double> optional_number(std::string_view name) const;
    [[nodiscard]] bool flag(std::string_view name) const;
    /// A word or a text; empty when it was not given.
    [[nodiscard]] std::string text(std::string_view name) const;
    /// Words or texts; empty when none were given.
    [[nodiscard]] std::vector<std::string> texts(std::string_view name) const;
    [[nodiscard]] std::vector<double> numbers(std::string_view name) const;
    /// @param height of a place that was given without one
    [[nodiscard]] std::optional<Geodetic> place(std::string_view name, Metres height) const;
    [[nodiscard]] const ParameterMap& values() const { return values_; }

private:
    ParameterMap values_;
};

/// What is wrong with one parameter.
struct ParameterMistake {
    std::string name;      ///< of the parameter; empty: of them all
    std::string sentence;  ///< "is 7; expected a number from 0 to 1"
};

/// A value as a parameter takes it: a lone text becomes a list where one is wanted. The mistake's sentence says what
/// was found and what was expected.
tl::expected<ParameterValue, ParameterMistake> accept(const ParameterSpec& spec, const ParameterValue& value);

/// What was given, checked, with the standards of what was not.
struct CheckedParameters {
    Parameters parameters;
    std::vector<ParameterMistake> mistakes;  ///< all of them; unknown names suggest the nearest known one
};
CheckedParameters check_parameters(std::span<const ParameterSpec> specs, const ParameterMap& given);

}  // namespace skyloop::inline run
