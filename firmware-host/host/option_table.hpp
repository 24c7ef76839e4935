/// The commands of the program with their options as a table, read from the command line's own declarations: what
/// manual pages, completions and the reference page are made of.
#pragma once

#include <CLI/CLI.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace skyloop::host {

/// What a value on the command line names, as far as a shell can help with it.
enum class ValueKind {
    none,    ///< a flag: no value
    text,    ///< anything; `words` may be among it
    words,   ///< one of `words`, and nothing else
    file,    ///< a file, or one of `words`
    folder,  ///< a folder
    board,   ///< a profile's name, as `skyloop boards` lists them, or a file
    fault,   ///< a fault's kind, as `skyloop faults` lists them
    uri      ///< begins with one of `words`, each of which ends in ':' where more has to follow
};

/// One option, or one word that stands without an option's name.
struct OptionRow {
    std::vector<std::string> names{};  ///< "--at", "-h"; empty for a word without a name
    std::string value{};               ///< what stands for its value in a synopsis: "FILE"; empty for a flag
    std::string meaning{};
    ValueKind kind = ValueKind::none;
    std::vector<std::string> words{};  ///< values that are known beforehand
    std::string range{};               ///< "0 to 90"; empty where nothing is said
    bool required = false;
    bool repeatable = false;

    [[nodiscard]] bool positional() const { return names.empty(); }
};

/// One command.
struct CommandRow {
    std::string name{};  ///< of a sub-command with that of its command: "campaign plan"
    std::string meaning{};
    std::string usage{};  ///< more than options say; lines as they stand
    bool hidden = false;  ///< not in `skyloop --help`
    std::vector<OptionRow> options{};
    std::vector<CommandRow> subcommands{};  ///< without hidden ones
};

/// "0 to 90" of an option whose type CLI11 tells as "FLOAT:FLOAT in [0 - 90]"; empty where it tells no range.
std::string declared_range(const std::string& type);

/// One option of `command`, whose name is with that of its command before it: "campaign plan".
OptionRow option_row(const CLI::Option& option, std::string_view command);

/// Its meaning with what else is declared of it, without a full stop: words, range, whether it is needed.
std::string option_sentence(const OptionRow& option);

/// All commands of `program` in the order of its help, hidden ones too.
std::vector<CommandRow> option_table(const CLI::App& program);

/// What is known of values beyond what the declarations say.
struct ValueRule {
    std::string_view option;   ///< "--at"; the declared name of a word without one
    std::string_view command;  ///< empty: of all
    std::string_view value;
    ValueKind kind;
    std::vector<std::string> words{};
};

/// The rules that `option_table` applies. A test holds them against the declarations: each is of an option that exists.
const std::vector<ValueRule>& value_rules();

/// A file for bash-completion's folder: bash 4.4 or later, with nothing else needed.
std::string bash_completion(std::span<const CommandRow> commands);
/// A file `_skyloop` for zsh's fpath.
std::string zsh_completion(std::span<const CommandRow> commands);

/// The manual page skyloop-NAME(1), in the macros of man(7).
std::string manual_page(const CommandRow& command, std::string_view version);
/// All commands with their options as one page of Markdown; hidden ones are left out.
std::string commands_markdown(std::span<const CommandRow> commands);

}  // namespace skyloop::host
