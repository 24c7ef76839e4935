/// What was wrong with the words of a command line, in one line.
/// Values of options, read more strictly than CLI11 does.
/// What `--help` prints.
#pragma once

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

namespace skyloop::host {

/// What `error`, thrown by `program` as it read its words, says of them.
std::string misuse_text(const CLI::App& program, const CLI::ParseError& error);

/// What is wrong with an option whose value is empty behind its '=': the next word would be taken for it. Of
/// `--option=` alone; nothing where all have values.
std::optional<std::string> value_left_out(const std::vector<std::string>& words);

/// Holds every option of `program` and of its subcommands that takes a number to plain ones: whole numbers are decimal
/// digits alone, within the range that the option declares (CLI::Range) or that its type has; others are finite.
void check_numbers(CLI::App& program);
/// Lets every option of `program` that takes a text refuse an empty one, as an unset variable of a script leaves it,
/// and another option in its place; those that take one of some words name them and the nearest.
void check_words(CLI::App& program);

/// Options with the names of their values, as on the manual pages, in lines that fit the terminal.
class HelpText : public CLI::Formatter {
public:
    std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;
    std::string make_option(const CLI::Option* option, bool is_positional) const override;
    std::string make_option_usage(const CLI::Option* option) const override;
    std::string make_subcommand(const CLI::App* command) const override;

private:
    mutable std::string command_;  // whose help it is, with that of its command: what values mean depends on it
};

}  // namespace skyloop::host
