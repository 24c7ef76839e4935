/// What a fault or a command is told: named values, checked against a table that also makes the documentation.
#pragma once

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/core/result.hpp"
#include "base/geo/geodetic.hpp"

namespace skyloop {

/// A value as scenario files, control messages and the command line give it.
using ParameterValue = std::variant<double, bool, std::string, std::vector<double>, std::vector<std::string>>;

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

/// One parameter: how it is called, with its unit, and what it takes.
struct ParameterSpec {
    std::string name;
    ParameterType type = ParameterType::number;
    std::string meaning;                       ///< for people, half a sentence
    std::optional<ParameterValue> standard{};  ///< what it is when it is not given; nothing: it is then absent
    bool needed = false;                       ///< it must be given
    double least = -std::numeric_limits<double>::max(), most = std::numeric_limits<double>::max();  ///< of numbers
    std::size_t count_least = 0, count_most = std::numeric_limits<std::size_t>::max();              ///< of lists
    std::vector<std::string> choices{};  ///< of `word` and `words`
};

/// Tables of parameters are written with these. A number without `standard` is absent unless given.
ParameterSpec number_parameter(std::string name, std::optional<double> standard, double least, double most,
                               std::string meaning);
ParameterSpec whole_number_parameter(std::string name, std::optional<double> standard, double least, double most,
                                     std::string meaning);
ParameterSpec needed_number(std::string name, double least, double most, std::string meaning);
ParameterSpec needed_whole_number(std::string name, double least, double most, std::string meaning);
ParameterSpec flag_parameter(std::string name, bool standard, std::string meaning);
ParameterSpec word_parameter(std::string name, std::string standard, std::vector<std::string> choices,
                             std::string meaning);
ParameterSpec words_parameter(std::string name, std::vector<std::string> choices, std::string meaning);
ParameterSpec text_parameter(std::string name, std::string standard, std::string meaning);
ParameterSpec texts_parameter(std::string name, std::string meaning);
/// [latitude, longitude] or [latitude, longitude, height]: degrees, metres above the ellipsoid.
ParameterSpec place_parameter(std::string name, bool needed, std::string meaning);
/// A list of at least three pairs of latitude and longitude, degrees, flat or pair by pair.
ParameterSpec polygon_parameter(std::string name, std::string meaning);
/// Which numbers a list takes.
struct ListLimits {
    std::size_t count = 2;  ///< exactly
    double least = -std::numeric_limits<double>::max(), most = std::numeric_limits<double>::max();
};
ParameterSpec numbers_parameter(std::string name, std::optional<std::vector<double>> standard, ListLimits limits,
                                std::string meaning);

/// Values that have been checked: every one that has a standard is there.
///
/// Asking for a parameter that its table does not have, or by the wrong type, is a mistake of the program.
class Parameters {
public:
    Parameters() = default;
    explicit Parameters(std::map<std::string, ParameterValue, std::less<>> values) : values_(std::move(values)) {}

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
    [[nodiscard]] const std::map<std::string, ParameterValue, std::less<>>& values() const { return values_; }

private:
    std::map<std::string, ParameterValue, std::less<>> values_;
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
CheckedParameters check_parameters(const std::vector<ParameterSpec>& specs,
                                   const std::map<std::string, ParameterValue, std::less<>>& given);

}  // namespace skyloop
