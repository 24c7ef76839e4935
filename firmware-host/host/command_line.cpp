#include "command_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/core/words.hpp"
#include "option_table.hpp"

namespace skyloop::host {
namespace {

// The command that was being read, and its name with that of its command.
std::pair<const CLI::App*, std::string> command_in_question(const CLI::App& program) {
    const CLI::App* command = &program;
    std::string name;
    // Words that nobody took before a command came.
    if (!program.remaining(false).empty()) return {command, name};
    for (auto below = program.get_subcommands(); !below.empty(); below = command->get_subcommands()) {
        command = below.front();
        name += (name.empty() ? "" : " ") + command->get_name();
    }
    return {command, name};
}

std::vector<std::string> long_names(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames())
            names.push_back("--" + name);
    return names;
}

bool holds(const std::vector<std::string>& names, std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

std::string unknown_option(const CLI::App& program, const CLI::App& command, std::string_view option) {
    const std::vector<std::string> names = long_names(command);
    std::vector<std::string> others;
    for (const CLI::App* other : program.get_subcommands(nullptr))
        if (holds(long_names(*other), option)) others.push_back(other->get_name());
    if (&command == &program)
        return fmt::format("'{}' stands before the command; expected skyloop COMMAND, then its options", option);
    std::string text = fmt::format("{} has no option {}", command.get_name(), option);
    // The recording of a run goes by two names.
    const std::string_view like = option == "--out" ? "--record" : option == "--record" ? "--out" : "";
    if (holds(names, like)) return text + fmt::format("; did you mean '{}'?", like);
    if (!others.empty()) return text + fmt::format(", which is one of {}", fmt::join(others, ", "));
    const std::vector<std::string_view> candidates(names.begin(), names.end());
    return text + did_you_mean(option, candidates);
}

std::string unexpected_words(const CLI::App& program, const CLI::App& command) {
    const std::vector<std::string> words = program.remaining(true);
    const std::string word = words.empty() ? "" : words.front();
    if (word.size() > 1 && word.front() == '-')
        return unknown_option(program, command, std::string_view(word).substr(0, word.find('=')));
    return fmt::format("'{}' is one word too many", word);
}

// CLI11 begins with the option's name: "--out: …".
std::string wrong_count(const CLI::App& command, const std::string& name, const std::string& said) {
    const std::string option = said.substr(0, said.find(':'));
    const CLI::Option* declared = command.get_option_no_throw(option);
    if (declared == nullptr) return said;
    if (said.ends_with("missing"))
        return fmt::format("{}: a value is missing; expected {}", option, option_row(*declared, name).value);
    return fmt::format("{}: is there {} times; expected it once", option, declared->count());
}

}  // namespace

std::string misuse_text(const CLI::App& program, const CLI::ParseError& error) {
    const auto [command, name] = command_in_question(program);
    std::string text = error.what();
    if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr)
        text = unexpected_words(program, *command);
    else if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr)
        text = wrong_count(*command, name, text);
    return fmt::format("{}; see skyloop {}--help", text, name.empty() ? "" : name + " ");
}

std::optional<std::string> value_left_out(const std::vector<std::string>& words) {
    for (const std::string_view word : words) {
        if (word == "--") break;
        if (word.size() > 3 && word.starts_with("--") && word.find('=') == word.size() - 1)
            return fmt::format("{}: a value is missing behind '='", word.substr(0, word.size() - 1));
    }
    return std::nullopt;
}

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

namespace {

constexpr std::size_t meaning_column = 30;

std::size_t line_width() {
    constexpr std::size_t of_files = 100, narrowest = 60, widest = 140;
    winsize size{};
    if (isatty(STDOUT_FILENO) != 1 || ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return of_files;
    return std::clamp<std::size_t>(size.ws_col, narrowest, widest);
}

// What stands on the left, and the meaning in lines beside it; below it where it is long.
std::string entry_lines(const std::string& head, std::string_view meaning, std::size_t width) {
    std::string text = "  " + head;
    std::size_t column = text.size();
    const auto new_line = [&] {
        text += "\n" + std::string(meaning_column, ' ');
        column = meaning_column;
    };
    if (column + 2 > meaning_column) {
        new_line();
    } else {
        text += std::string(meaning_column - column, ' ');
        column = meaning_column;
    }
    for (bool first = true; !meaning.empty(); first = false) {
        const std::string_view word = meaning.substr(0, std::min(meaning.find(' '), meaning.size()));
        meaning.remove_prefix(std::min(word.size() + 1, meaning.size()));
        if (!first && column + 1 + word.size() > width) {
            new_line();
            first = true;
        }
        text += first ? std::string(word) : " " + std::string(word);
        column += word.size() + (first ? 0 : 1);
    }
    return text + "\n";
}

std::string names_of(const std::set<CLI::Option*>& options) {
    std::vector<std::string> names;
    for (const CLI::Option* option : options)
        names.push_back(option->get_name());
    std::sort(names.begin(), names.end());
    return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

std::string HelpText::make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const {
    command_.clear();
    for (const CLI::App* one = app; one->get_parent() != nullptr; one = one->get_parent())
        command_ = one->get_name() + (command_.empty() ? "" : " ") + command_;
    return Formatter::make_help(app, std::move(name), mode);
}

std::string HelpText::make_option(const CLI::Option* option, bool is_positional) const {
    const OptionRow row = option_row(*option, command_);
    std::string head = is_positional ? row.value : option->get_name(false, true);
    if (!is_positional && !row.value.empty()) head += " " + row.value;
    std::string meaning = option_sentence(row);
    if (!option->get_needs().empty()) meaning += "; with " + names_of(option->get_needs());
    if (!option->get_excludes().empty()) meaning += "; not with " + names_of(option->get_excludes());
    return entry_lines(head, meaning, line_width());
}

std::string HelpText::make_option_usage(const CLI::Option* option) const {
    const std::string value = option_row(*option, command_).value;
    return option->get_required() ? value : "[" + value + "]";
}

std::string HelpText::make_subcommand(const CLI::App* command) const {
    return entry_lines(command->get_name(), command->get_description(), line_width());
}

}  // namespace skyloop::host
