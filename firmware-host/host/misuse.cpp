#include "misuse.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "base/core/spelling.hpp"
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

}  // namespace skyloop::host
