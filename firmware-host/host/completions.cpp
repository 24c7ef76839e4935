#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <map>
#include <string_view>

#include "option_table.hpp"

namespace skyloop::host {
namespace {

// In single quotes a shell reads everything but a single quote as it stands.
std::string single_quoted(std::string_view text) {
    std::string quoted = "'";
    for (const char c : text)
        quoted += c == '\'' ? "'\\''" : std::string(1, c);
    return quoted + "'";
}

std::vector<std::string> shown_commands(std::span<const CommandRow> commands) {
    std::vector<std::string> names;
    for (const CommandRow& command : commands)
        if (!command.hidden) names.push_back(command.name);
    return names;
}

// Each command with its sub-commands behind it.
std::vector<CommandRow> with_subcommands(std::span<const CommandRow> commands) {
    std::vector<CommandRow> all;
    for (const CommandRow& command : commands) {
        all.push_back(command);
        all.insert(all.end(), command.subcommands.begin(), command.subcommands.end());
    }
    return all;
}

// Patterns of a shell's case, such as 'campaign plan' | 'campaign replay'; empty: no command has any.
std::string subcommand_patterns(std::span<const CommandRow> commands) {
    std::vector<std::string> names;
    for (const CommandRow& command : commands)
        for (const CommandRow& below : command.subcommands)
            names.push_back(single_quoted(below.name));
    return fmt::format("{}", fmt::join(names, " | "));
}

std::string_view bash_kind(ValueKind kind) {
    constexpr std::array<std::string_view, 8> names{"none", "text", "words", "file", "folder", "board", "fault", "uri"};
    return names[static_cast<std::size_t>(kind)];
}

// Names of options, and which of them take a value: one branch a command.
std::string bash_options(std::span<const CommandRow> commands) {
    std::string branches;
    for (const CommandRow& command : commands) {
        std::vector<std::string> all, valued;
        for (const OptionRow& option : command.options) {
            all.insert(all.end(), option.names.begin(), option.names.end());
            if (option.kind != ValueKind::none) valued.insert(valued.end(), option.names.begin(), option.names.end());
        }
        branches += fmt::format("        {}) options={} valued={} ;;\n", single_quoted(command.name),
                                single_quoted(fmt::format("{}", fmt::join(all, " "))),
                                single_quoted(fmt::format(" {} ", fmt::join(valued, " "))));
    }
    return branches;
}

// What is known of each value: one branch for all options that are alike. "run 1" is the first word of run without an
// option.
std::string bash_values(std::span<const CommandRow> commands) {
    std::map<std::string, std::vector<std::string>> alike;
    for (const CommandRow& command : commands) {
        int position = 0;
        for (const OptionRow& option : command.options) {
            if (option.positional()) ++position;
            const std::string what = fmt::format("kind={} known={}", bash_kind(option.kind),
                                                 single_quoted(fmt::format("{}", fmt::join(option.words, " "))));
            if (option.kind == ValueKind::none || (option.kind == ValueKind::text && option.words.empty())) continue;
            if (option.positional()) alike[what].push_back(fmt::format("'{} {}'", command.name, position));
            for (const std::string& name : option.names)
                alike[what].push_back(fmt::format("'{} {}'", command.name, name));
        }
    }
    std::string branches;
    for (const auto& [what, patterns] : alike)
        branches += fmt::format("        {}) {} ;;\n", fmt::join(patterns, " | "), what);
    return branches;
}

constexpr std::string_view bash_head =
    R"(# bash completion for skyloop(1)                              -*- shell-script -*-
# Written by skyloop help-pages, from what the commands declare.

# _skyloop_reply KIND KNOWN HEAD CURRENT: what CURRENT may become, behind HEAD.
_skyloop_reply()
{
    local kind=$1 known=$2 head=$3 cur=$4 name line cut='' i
    local -a found
    case $kind in
        board) while read -r name line; do
                   known+=" $name"
                   [[ $line == *']' ]] && line=${line##*'['} && known+=" ${line//[],]/}"
               done < <(skyloop boards 2>/dev/null) ;;
        fault) while IFS= read -r line; do
                   [[ $line == '  '* ]] && read -r name _ <<<"$line" && known+=" $name"
               done < <(skyloop faults 2>/dev/null) ;;
        uri)   if [[ $cur =~ ^[a-z0-9]+= ]]; then
                   head+=${BASH_REMATCH[0]} cur=${cur#*=}
               fi
               compopt -o nospace 2>/dev/null
               if [[ $cur == *:* ]]; then
                   head+=${cur%%:*}: cur=${cur#*:} known='' kind=file
               fi ;;
    esac
    mapfile -t found < <(compgen -W "$known" -- "$cur")
    case $kind in
        file | board)
            compopt -o filenames 2>/dev/null
            mapfile -t -O "${#found[@]}" found < <(compgen -f -- "$cur") ;;
        folder)
            compopt -o filenames 2>/dev/null
            mapfile -t -O "${#found[@]}" found < <(compgen -d -- "$cur") ;;
    esac
    # Readline replaces only what follows the last of these marks, where it breaks words at them.
    for ((i = ${#head}; i > 0; i--)); do
        if [[ ${head:i-1:1} == [:=] && $COMP_WORDBREAKS == *"${head:i-1:1}"* ]]; then
            cut=${head:0:i}
            break
        fi
    done
    COMPREPLY=()
    for name in "${found[@]}"; do
        name=$head$name
        COMPREPLY+=("${name#"$cut"}")
    done
}

)";

constexpr std::string_view bash_middle = R"(
# The line is read anew: bash has cut its words at ':' and '='. They are offered without quotes; readline puts them back.
_skyloop()
{
    local line=${COMP_LINE:0:COMP_POINT} command='' options='' valued='' head='' cur prev i position=1 first=2
    local quote='' char word=''
    local -a words
    for ((i = 0; i < ${#line}; i++)); do
        char=${line:i:1}
        if [[ -n $quote && $char == "$quote" ]]; then
            quote=''
        elif [[ -z $quote && ($char == "'" || $char == '"') ]]; then
            quote=$char
        elif [[ $quote != "'" && $char == "\\" ]]; then
            ((i++))
            word+=${line:i:1}
        elif [[ -z $quote && $char == [[:space:]] ]]; then
            [[ -n $word ]] && words+=("$word")
            word=''
        else
            word+=$char
        fi
    done
    words+=("$word")
    cur=$word
    if ((${#words[@]} <= 2)); then
        COMPREPLY=()
)";

constexpr std::string_view bash_tail = R"(    for ((i = first; i < ${#words[@]} - 1; i++)); do
        if [[ $valued == *" ${words[i]} "* ]]; then
            ((i++))
        elif [[ ${words[i]} != -* ]]; then
            ((position++))
        fi
    done
    prev=${words[-2]}
    if [[ $cur == --*=* ]]; then
        prev=${cur%%=*} head=${cur%%=*}= cur=${cur#*=}
    elif ((${#words[@]} == first + 1)) || [[ $valued != *" $prev "* ]]; then
        if [[ $cur == -* ]]; then
            _skyloop_reply words "$options" '' "$cur"
            return
        fi
        prev=$position
    fi
    _skyloop_value "$command $prev"
    _skyloop_reply "$kind" "$known" "$head" "$cur"
}

complete -F _skyloop skyloop
)";

// zsh: in `_arguments` a colon separates, brackets enclose, a backslash takes their meaning.
std::string zsh_escaped(std::string_view text) {
    std::string escaped;
    for (const char c : text) {
        if (c == ':' || c == '[' || c == ']' || c == '\\') escaped += '\\';
        escaped += c;
    }
    return escaped;
}

std::string zsh_words(const OptionRow& option) {
    std::vector<std::string> words;
    for (const std::string& word : option.words)
        words.push_back(zsh_escaped(word));
    return fmt::format("{}", fmt::join(words, " "));
}

std::string zsh_action(const OptionRow& option) {
    switch (option.kind) {
        case ValueKind::none:
            return {};
        case ValueKind::text:
        case ValueKind::words:
            return option.words.empty() ? " " : "(" + zsh_words(option) + ")";
        case ValueKind::file:
            return option.words.empty()
                       ? "_files"
                       : fmt::format("{{_alternative \"words:word:({})\" \"files:file:_files\"}}", zsh_words(option));
        case ValueKind::folder:
            return "_files -/";
        case ValueKind::board:
            return "{_skyloop_boards}";
        case ValueKind::fault:
            return "{_skyloop_faults}";
        case ValueKind::uri:
            return fmt::format("{{_skyloop_uri {}}}", zsh_words(option));
    }
    return {};
}

std::string zsh_specs(const CommandRow& command) {
    std::string specs;
    int position = 0;
    for (const OptionRow& option : command.options) {
        const std::string value = fmt::format("{}:{}", zsh_escaped(option.value), zsh_action(option));
        if (option.positional()) {
            ++position;
            specs += " \\\n                " +
                     single_quoted(fmt::format("{}{}{}", position, option.required ? ":" : "::", value));
        }
        const std::string others = option.repeatable ? "*" : fmt::format("({})", fmt::join(option.names, " "));
        const bool valued = option.kind != ValueKind::none;
        for (const std::string& name : option.names)
            // With "=" a value may stand in the same word, as --rate=5, or in the next.
            specs +=
                " \\\n                " +
                single_quoted(fmt::format("{}{}{}[{}]{}", others, name, valued && name.starts_with("--") ? "=" : "",
                                          zsh_escaped(option.meaning), valued ? ":" + value : ""));
    }
    return specs;
}

constexpr std::string_view zsh_head = R"zsh(#compdef skyloop
# Written by skyloop help-pages, from what the commands declare.

_skyloop_boards() {
    local -a lines names
    lines=(${(f)"$(skyloop boards 2>/dev/null)"})
    names=(${lines%% *} ${=${${${(M)lines:#*\]}##*\[}//[],]/}})
    _alternative 'boards:board:compadd -a names' 'files:file:_files'
}

_skyloop_faults() {
    local -a names
    names=(${${${(M)${(f)"$(skyloop faults 2>/dev/null)"}:#  *}##  }%% *})
    compadd -a names
}

_skyloop_uri() {
    compset -P '[a-z0-9]#='
    if compset -P '*:'; then
        _files
    else
        compadd -S '' -- "$@"
    fi
}

_skyloop() {
    setopt localoptions extendedglob
    local curcontext=$curcontext state line ret=1
    typeset -A opt_args
    _arguments -C '(- *)--help[Print the help]' '(- *)--version[Print the version]' '1:command:->command' \
        '*::argument:->arguments' && ret=0
    case $state in
        command)
            local -a commands
            commands=(
)zsh";

}  // namespace

std::string bash_completion(std::span<const CommandRow> commands) {
    std::string script(bash_head);
    const std::vector<CommandRow> all = with_subcommands(commands);
    script += "_skyloop_value()\n{\n    kind=text known=''\n    case $1 in\n" + bash_values(all) + "    esac\n}\n";
    script += bash_middle;
    script += fmt::format("        _skyloop_reply words '{} --help --version' '' \"$cur\"\n        return\n    fi\n",
                          fmt::join(shown_commands(commands), " "));
    script += "    command=${words[1]}\n    local kind known\n";
    if (const std::string below = subcommand_patterns(commands); !below.empty())
        script += fmt::format(
            "    if ((${{#words[@]}} > 3)); then\n        case \"$command ${{words[2]}}\" in\n            {}) "
            "command+=\" ${{words[2]}}\" first=3 ;;\n        esac\n    fi\n",
            below);
    script += "    case $command in\n" + bash_options(all) + "    esac\n";
    return script + std::string(bash_tail);
}

std::string zsh_completion(std::span<const CommandRow> commands) {
    std::string script(zsh_head);
    for (const CommandRow& command : commands)
        if (!command.hidden)
            script += "                " +
                      single_quoted(zsh_escaped(command.name) + ":" + zsh_escaped(command.meaning)) + "\n";
    script +=
        "            )\n            _describe command commands && ret=0 ;;\n        arguments)\n            local "
        "called=$words[1]\n";
    if (const std::string below = subcommand_patterns(commands); !below.empty())
        script += fmt::format(
            "            if (( CURRENT > 2 )); then\n                case \"$words[1] $words[2]\" in\n"
            "                    {}) called+=\" $words[2]\"; shift words; (( CURRENT-- )) ;;\n                esac\n   "
            "         fi\n",
            below);
    script += "            case $called in\n";
    for (const CommandRow& command : with_subcommands(commands))
        script += fmt::format("            {}) _arguments -C -s{} && ret=0 ;;\n", single_quoted(command.name),
                              zsh_specs(command));
    return script + "            esac ;;\n    esac\n    return ret\n}\n\n_skyloop \"$@\"\n";
}

}  // namespace skyloop::host
