#include "run/fault/parameters.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/core/number_text.hpp"
#include "base/core/words.hpp"

namespace skyloop::inline run {
namespace {

using Accepted = tl::expected<ParameterValue, ParameterMistake>;

// With as many digits as it takes to tell it from its neighbours: 1.0000001 is not 1.
std::string number_text(double number) {
    const std::string text = fmt::format("{:g}", number);
    return std::isfinite(number) && number_in<double>(text) != number ? fmt::format("{}", number) : text;
}

std::string found(const ParameterValue& value) {
    if (const auto* number = std::get_if<double>(&value)) return number_text(*number);
    if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
    if (const auto* text = std::get_if<std::string>(&value)) return fmt::format("'{}'", *text);
    const auto* numbers = std::get_if<std::vector<double>>(&value);
    const auto* texts = std::get_if<std::vector<std::string>>(&value);
    if (numbers != nullptr ? numbers->empty() : texts->empty()) return "an empty list";
    return numbers != nullptr ? fmt::format("a list of {} numbers", numbers->size()) : "a list of texts";
}

Accepted refused(const ParameterSpec& spec, const ParameterValue& value, const std::string& expected) {
    return tl::make_unexpected(
        ParameterMistake{std::string(spec.name), fmt::format("is {}; expected {}", found(value), expected)});
}

bool unlimited(double limit) { return std::abs(limit) >= ParameterSpec::unlimited; }

std::string range_text(const ParameterSpec& spec) {
    if (unlimited(spec.least) && unlimited(spec.most)) return "";
    if (unlimited(spec.most)) return fmt::format(" of at least {:g}", spec.least);
    if (unlimited(spec.least)) return fmt::format(" of at most {:g}", spec.most);
    return fmt::format(" from {:g} to {:g}", spec.least, spec.most);
}

bool within(const ParameterSpec& spec, double number) {
    return std::isfinite(number) && number >= spec.least && number <= spec.most;
}

bool chosen(const ParameterSpec& spec, const std::string& word) {
    return std::find(spec.choices.begin(), spec.choices.end(), word) != spec.choices.end();
}

Accepted accept_number(const ParameterSpec& spec, const ParameterValue& value) {
    const auto* number = std::get_if<double>(&value);
    const bool whole = spec.type == ParameterType::whole_number;
    const bool right = number != nullptr && within(spec, *number) && (!whole || *number == std::floor(*number));
    if (!right) return refused(spec, value, (whole ? "a whole number" : "a number") + range_text(spec));
    return *number;
}

Accepted accept_word(const ParameterSpec& spec, const ParameterValue& value) {
    const auto* word = std::get_if<std::string>(&value);
    if (word == nullptr || !chosen(spec, *word))
        return refused(spec, value, fmt::format("one of {}", fmt::join(spec.choices, ", ")));
    return *word;
}

Accepted accept_texts(const ParameterSpec& spec, const ParameterValue& value) {
    const bool words = spec.type == ParameterType::words;
    const std::string expected =
        words ? fmt::format("some of {}", fmt::join(spec.choices, ", ")) : std::string("a text or a list of texts");
    std::vector<std::string> texts;
    if (const auto* text = std::get_if<std::string>(&value))
        texts = {*text};
    else if (const auto* list = std::get_if<std::vector<std::string>>(&value))
        texts = *list;
    else if (const auto* numbers = std::get_if<std::vector<double>>(&value); numbers == nullptr || !numbers->empty())
        return refused(spec, value, expected);
    if (texts.size() < spec.count_least) return refused(spec, value, expected);
    for (const std::string& text : texts)
        if (words && !chosen(spec, text)) return refused(spec, text, expected);
    return texts;
}

std::string count_text(const ParameterSpec& spec) {
    if (spec.count_least == spec.count_most) return fmt::format("{}", spec.count_least);
    if (spec.count_most == ParameterSpec::any_count) return fmt::format("at least {}", spec.count_least);
    return fmt::format("{} to {}", spec.count_least, spec.count_most);
}

Accepted accept_numbers(const ParameterSpec& spec, const ParameterValue& value) {
    const auto* numbers = std::get_if<std::vector<double>>(&value);
    const std::string expected = fmt::format("a list of {} numbers{}", count_text(spec), range_text(spec));
    if (numbers == nullptr || numbers->size() < spec.count_least || numbers->size() > spec.count_most)
        return refused(spec, value, expected);
    for (const double number : *numbers)
        if (!within(spec, number))
            return tl::make_unexpected(ParameterMistake{
                std::string(spec.name), fmt::format("holds {}; expected {}", number_text(number), expected)});
    return *numbers;
}

template <class Value>
const Value* find_value(const ParameterMap& values, std::string_view name) {
    const auto found_value = values.find(name);
    return found_value == values.end() ? nullptr : std::get_if<Value>(&found_value->second);
}

template <class Value>
Value value_or_nothing(const ParameterMap& values, std::string_view name) {
    const auto* value = find_value<Value>(values, name);
    return value == nullptr ? Value() : *value;
}

std::vector<std::string_view> names_of(std::span<const ParameterSpec> specs) {
    std::vector<std::string_view> names;
    for (const ParameterSpec& spec : specs)
        names.push_back(spec.name);
    return names;
}

}  // namespace

std::optional<ParameterValue> ParameterSpec::standard_value() const {
    if (const double* number = std::get_if<double>(&standard)) return *number;
    if (const bool* flag = std::get_if<bool>(&standard)) return *flag;
    if (const auto* text = std::get_if<std::string_view>(&standard)) return std::string(*text);
    return std::nullopt;
}

double Parameters::number(std::string_view name) const { return optional_number(name).value_or(0); }

std::optional<double> Parameters::optional_number(std::string_view name) const {
    const auto* value = find_value<double>(values_, name);
    return value == nullptr ? std::nullopt : std::optional(*value);
}

bool Parameters::flag(std::string_view name) const { return value_or_nothing<bool>(values_, name); }

std::string Parameters::text(std::string_view name) const { return value_or_nothing<std::string>(values_, name); }

std::vector<std::string> Parameters::texts(std::string_view name) const {
    return value_or_nothing<std::vector<std::string>>(values_, name);
}

std::vector<double> Parameters::numbers(std::string_view name) const {
    return value_or_nothing<std::vector<double>>(values_, name);
}

std::optional<Geodetic> Parameters::place(std::string_view name, Metres height) const {
    const std::vector<double> parts = numbers(name);
    if (parts.size() < 2) return std::nullopt;
    const auto place = place_from_degrees(parts[0], parts[1], parts.size() > 2 ? parts[2] : height.value());
    return place ? std::optional(*place) : std::nullopt;
}

tl::expected<ParameterValue, ParameterMistake> accept(const ParameterSpec& spec, const ParameterValue& value) {
    switch (spec.type) {
        case ParameterType::number:
        case ParameterType::whole_number:
            return accept_number(spec, value);
        case ParameterType::flag:
            if (!std::holds_alternative<bool>(value)) return refused(spec, value, "true or false");
            return value;
        case ParameterType::word:
            return accept_word(spec, value);
        case ParameterType::text:
            if (!std::holds_alternative<std::string>(value)) return refused(spec, value, "a text");
            return value;
        case ParameterType::words:
        case ParameterType::texts:
            return accept_texts(spec, value);
        case ParameterType::numbers:
            return accept_numbers(spec, value);
    }
    return value;
}

CheckedParameters check_parameters(std::span<const ParameterSpec> specs, const ParameterMap& given) {
    CheckedParameters checked;
    ParameterMap values;
    for (const ParameterSpec& spec : specs) {
        const auto value = given.find(spec.name);
        const std::string name(spec.name);
        if (value == given.end()) {
            if (auto standard = spec.standard_value()) values.emplace(name, std::move(*standard));
            if (spec.needed) checked.mistakes.push_back({name, fmt::format("is missing; expected {}", spec.meaning)});
            continue;
        }
        auto accepted = accept(spec, value->second);
        if (accepted)
            values.emplace(name, std::move(*accepted));
        else
            checked.mistakes.push_back(accepted.error());
    }
    const std::vector<std::string_view> known = names_of(specs);
    for (const auto& [name, value] : given)
        if (std::find(known.begin(), known.end(), name) == known.end())
            checked.mistakes.push_back({name, "is not known here" + did_you_mean(name, known)});
    checked.parameters = Parameters(std::move(values));
    return checked;
}

}  // namespace skyloop::inline run
