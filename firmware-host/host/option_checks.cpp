#include "option_checks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/core/spelling.hpp"
#include "option_table.hpp"

namespace skyloop::host {
namespace {

struct WholeRange {
    std::uint64_t least = 0, most = 0;
};

template <class Number>
bool reads_as(std::string_view text, Number& value) {
    const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && rest == text.data() + text.size();
}

// `declared` is "1 to 1024"; empty where the option says nothing.
WholeRange whole_range(const std::string& declared, bool with_sign) {
    WholeRange range{0, with_sign ? static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())
                                  : std::numeric_limits<std::uint64_t>::max()};
    const std::size_t middle = declared.find(" to ");
    if (middle == std::string::npos) return range;
    reads_as(std::string_view(declared).substr(0, middle), range.least);
    reads_as(std::string_view(declared).substr(middle + 4), range.most);
    return range;
}

// CLI11 reads as strtoull does: -1 is the largest number, 010 is eight and what is too large the largest again.
CLI::Validator whole_number(WholeRange range) {
    const auto read = [range](std::string& text) {
        std::uint64_t value = 0;
        if (!reads_as(text, value) || value < range.least || value > range.most)
            return fmt::format("'{}'; expected a whole number from {} to {}", text, range.least, range.most);
        text = fmt::format("{}", value);
        return std::string();
    };
    return {read, "", "whole_number"};
}

// "0 to 90"; all numbers where nothing is declared.
std::pair<double, double> number_range(const std::string& declared) {
    std::pair<double, double> range{std::numeric_limits<double>::lowest(), std::numeric_limits<double>::max()};
    const std::size_t middle = declared.find(" to ");
    if (middle == std::string::npos) return range;
    reads_as(std::string_view(declared).substr(0, middle), range.first);
    reads_as(std::string_view(declared).substr(middle + 4), range.second);
    return range;
}

// No comparison with a range refuses nan.
CLI::Validator finite_number(const std::string& declared) {
    const auto read = [declared, range = number_range(declared)](const std::string& text) {
        double value = 0;
        if (reads_as(text, value) && value >= range.first && value <= range.second) return std::string();
        return fmt::format("'{}'; expected a number{}", text, declared.empty() ? "" : " from " + declared);
    };
    return {read, "", "finite_number"};
}

// Whether the option names what is written. Of these only solve's fixes may go to standard output, where the others
// would be among what the command says.
bool names_output(const OptionRow& row, std::string_view command) {
    static constexpr std::array<std::string_view, 6> outputs{"--junit",   "--out",   "--record",
                                                             "--sky-svg", "--state", "--svg"};
    return !row.positional() && command != "solve" &&
           std::find(outputs.begin(), outputs.end(), row.names.front()) != outputs.end();
}

CLI::Validator some_text(const std::string& expected, bool options_too, bool output) {
    const auto read = [expected, options_too, output](const std::string& text) {
        if (text.empty()) return fmt::format("''; expected {}", expected);
        if (text == "-" && output)
            return fmt::format("'-' is not standard output here; expected {}, or ./- for that name", expected);
        if (text.starts_with("--") && !options_too)
            return fmt::format("'{}' is an option; expected {}", text, expected);
        return std::string();
    };
    return {read, "", "some_text"};
}

CLI::Validator one_of(const std::vector<std::string>& words) {
    const auto read = [words](const std::string& text) {
        if (std::find(words.begin(), words.end(), text) != words.end()) return std::string();
        const std::vector<std::string_view> candidates(words.begin(), words.end());
        return fmt::format("'{}'; expected one of {}{}", text, fmt::join(words, " "), did_you_mean(text, candidates));
    };
    return {read, "", "one_of"};
}

void check_words_of(CLI::App& command, const std::string& name) {
    for (CLI::Option* option : command.get_options()) {
        const std::string type = option->get_type_name();
        if (!type.starts_with("TEXT") || option->get_expected_max() == 0) continue;
        const OptionRow row = option_row(*option, name);
        // Before what the option declares itself.
        if (row.kind == ValueKind::words && type.find('{') != std::string::npos)
            option->transform(one_of(row.words));
        else
            option->transform(some_text(row.value, option->check_lname("sbatch-option"), names_output(row, name)));
    }
    for (CLI::App* below : command.get_subcommands(nullptr))
        check_words_of(*below, name.empty() ? below->get_name() : name + " " + below->get_name());
}

}  // namespace

void check_numbers(CLI::App& program) {
    for (CLI::Option* option : program.get_options()) {
        const std::string type = option->get_type_name();
        const std::string declared = declared_range(type);
        // Before the option's own range, which reads the text as CLI11 does.
        if (type.starts_with("UINT") || type.starts_with("INT"))
            option->transform(whole_number(whole_range(declared, type.starts_with("INT"))));
        else if (type.starts_with("FLOAT"))
            option->transform(finite_number(declared));
    }
    for (CLI::App* command : program.get_subcommands(nullptr))
        check_numbers(*command);
}

void check_words(CLI::App& program) { check_words_of(program, ""); }

}  // namespace skyloop::host
