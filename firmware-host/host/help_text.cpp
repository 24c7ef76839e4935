#include "help_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <string_view>

#include "option_table.hpp"

namespace skyloop::host {
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
