#include "word_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/spelling.hpp"
#include "option_table.hpp"

namespace skyloop::host {
namespace {

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

void check_words(CLI::App& program) { check_words_of(program, ""); }

}  // namespace skyloop::host
