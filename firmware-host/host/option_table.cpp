#include "option_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "motion/trajectory/vehicle.hpp"
#include "run/scenario/scenario.hpp"

namespace skyloop::host {
namespace {

std::vector<std::string> vehicle_words() {
    const auto names = track_vehicle_names();
    return {names.begin(), names.end()};
}

std::vector<ValueRule> option_rules() {
    using enum ValueKind;
    return {
        {"--at", "", "LAT,LON[,HEIGHT]", text},
        {"--axes", "", "EAST,NORTH,UP", text},
        {"--board", "", "NAME", board},
        {"--caster", "", "[HOST:]PORT", text},
        {"--check", "", "FILE", file},
        {"--control", "", "[HOST:]PORT", text},
        {"--corrections", "", "URI", text},
        {"--date", "", "DAY", text},
        {"--file-origin", "", "X,Y,Z", text},
        {"--grid", "", "WEST,SOUTH,EAST,NORTH", text},
        {"--junit", "", "FILE", file},
        {"--mavlink", "", "ADDRESS", uri},
        {"--mirror", "", "NAME|ADDRESS", text},
        {"--nav", "", "FILE", file, {"auto"}},
        {"--origin", "", "LAT,LON[,HEIGHT]", text},
        {"--out", "", "DIR", folder},
        {"--out", "campaign report", "FILE", file},
        {"--out", "solve", "FILE", file},
        {"--record", "", "DIR", folder},
        {"--reference", "", "LAT,LON,HEIGHT|own-mean", text, {"own-mean"}},
        {"--reference", "fit", "LAT,LON,HEIGHT", text},
        {"--repeat", "", "DIR", folder},
        {"--run", "", "DIR", folder},
        {"--scene", "", "FILE", file, {"demo"}},
        {"--sky-svg", "", "FILE", file},
        {"--sp3", "", "FILE", file},
        {"--speed", "run", "X|max", text, {"max"}},
        {"--start", "", "TIME", text, {"now"}},
        {"--start", "fit", "TIME", text},
        {"--state", "", "FILE", file},
        {"--svg", "", "FILE", file},
        {"--to", "", "DIR", folder},
        {"--token", "", "TEXT", text},
        {"--trajectory", "", "FILE", file},
        {"--vehicle", "", "CLASS", words, vehicle_words()},
    };
}

std::vector<ValueRule> word_rules() {
    using enum ValueKind;
    return {
        {"A", "compare", "A", file},
        {"B", "compare", "B", file},
        {"FILE", "decode", "FILE", file},
        {"FILE", "scene", "FILE", file, {"demo"}},
        {"NAME", "boards", "NAME", board},
        {"NAME", "faults", "NAME", fault},
        {"OBSERVATIONS", "solve", "OBSERVATIONS", file},
        {"RECORDING", "replay", "RECORDING", file},
        {"FILE", "trajectory", "FILE", file},
        {"DIR", "campaign gather", "DIR", folder},
        {"DIR", "campaign report", "DIR", folder},
        {"LOG", "", "LOG", file},
        {"SCENARIO", "", "SCENARIO", file},
        {"URI", "power", "URI", uri},
    };
}

const ValueRule* rule_of(std::string_view option, std::string_view command) {
    const ValueRule* general = nullptr;
    for (const ValueRule& rule : value_rules()) {
        if (rule.option != option) continue;
        if (rule.command == command) return &rule;
        if (rule.command.empty()) general = &rule;
    }
    return general;
}

// CLI11 shows the words of a set as "TEXT:{a,b}".
std::vector<std::string> set_of(const std::string& type) {
    const std::size_t open = type.find('{'), close = type.rfind('}');
    std::vector<std::string> words;
    if (open == std::string::npos || close == std::string::npos || close < open) return words;
    std::string word;
    for (std::size_t i = open + 1; i <= close; ++i) {
        if (type[i] != ',' && i != close) {
            word += type[i];
        } else if (!word.empty()) {
            words.push_back(std::exchange(word, {}));
        }
    }
    return words;
}

bool is_scheme_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-'; }

// A help text that lists URIs has words such as "tcp:[HOST:]PORT" and "pty[:LINK]". The latter stands without more,
// too.
std::vector<std::string> schemes_in(const std::string& meaning) {
    std::vector<std::string> schemes;
    std::size_t begin = 0;
    while (begin < meaning.size()) {
        const std::size_t end = std::min(meaning.find(' ', begin), meaning.size());
        const std::string_view word = std::string_view(meaning).substr(begin, end - begin);
        begin = end + 1;
        const auto letters =
            static_cast<std::size_t>(std::find_if_not(word.begin(), word.end(), is_scheme_letter) - word.begin());
        const std::string_view rest = word.substr(letters);
        const std::string scheme(word.substr(0, letters));
        const auto is_value = [](std::string_view text) {
            return !text.empty() && (text[0] == '[' || (text[0] >= 'A' && text[0] <= 'Z'));
        };
        if (letters == 0) continue;
        if (rest.starts_with(":") && is_value(rest.substr(1))) schemes.push_back(scheme + ":");
        if (rest.starts_with("[:")) schemes.insert(schemes.end(), {scheme, scheme + ":"});
    }
    std::vector<std::string> once;
    for (std::string& scheme : schemes)
        if (std::find(once.begin(), once.end(), scheme) == once.end()) once.push_back(std::move(scheme));
    return once;
}

std::string placeholder(const std::string& type) {
    if (type.starts_with("FLOAT") || type.starts_with("INT") || type.starts_with("UINT")) return "N";
    return "TEXT";
}

void add_value(const CLI::Option& option, std::string_view declared, std::string_view command, OptionRow& row) {
    const std::string type = option.get_type_name();
    row.value = placeholder(type);
    row.kind = ValueKind::text;
    row.range = declared_range(type);
    row.words = schemes_in(row.meaning);
    if (!row.words.empty()) {
        row.kind = ValueKind::uri;
        row.value = "URI";
    }
    if (const ValueRule* rule = rule_of(declared, command)) {
        row.value = rule->value;
        row.kind = rule->kind;
        if (rule->kind != ValueKind::uri) row.words = rule->words;
    }
    if (std::vector<std::string> set = set_of(type); !set.empty()) {
        row.kind = ValueKind::words;
        row.words = std::move(set);
        if (row.value == "TEXT") row.value = "WORD";
    }
}

}  // namespace

OptionRow option_row(const CLI::Option& option, std::string_view command) {
    OptionRow row;
    for (const std::string& name : option.get_lnames())
        row.names.push_back("--" + name);
    for (const std::string& name : option.get_snames())
        row.names.push_back("-" + name);
    row.meaning = option.get_description();
    row.required = option.get_required();
    row.repeatable = option.get_items_expected_max() > 1 && !row.positional();
    const std::string declared = option.get_positional() ? option.get_name(true) : row.names.front();
    if (option.get_expected_max() > 0) add_value(option, declared, command, row);
    return row;
}

namespace {

CommandRow command_row(const CLI::App& command, const std::string& before) {
    CommandRow row;
    row.name = before + command.get_name();
    row.meaning = command.get_description();
    row.usage = command.get_footer();
    row.hidden = command.get_group().empty();
    for (const CLI::Option* option : command.get_options())
        row.options.push_back(option_row(*option, row.name));
    for (const CLI::App* below : command.get_subcommands(nullptr))
        if (!below->get_group().empty()) row.subcommands.push_back(command_row(*below, row.name + " "));
    const auto first = std::find_if(row.options.begin(), row.options.end(),
                                    [](const OptionRow& option) { return option.positional(); });
    // A sub-command stands where the command's first word could.
    for (const CLI::App* below : command.get_subcommands(nullptr))
        if (!below->get_group().empty() && first != row.options.end()) first->words.push_back(below->get_name());
    return row;
}

}  // namespace

const std::vector<ValueRule>& value_rules() {
    static const std::vector<ValueRule> rules = [] {
        std::vector<ValueRule> all = option_rules();
        for (ValueRule& rule : word_rules())
            all.push_back(std::move(rule));
        return all;
    }();
    return rules;
}

// CLI11 shows a range as "FLOAT:FLOAT in [0 - 90]".
std::string declared_range(const std::string& type) {
    const std::size_t open = type.find(" in ["), close = type.rfind(']');
    if (open == std::string::npos || close == std::string::npos) return {};
    std::string range = type.substr(open + 5, close - open - 5);
    if (const std::size_t dash = range.find(" - "); dash != std::string::npos) range.replace(dash, 3, " to ");
    return range;
}

std::string option_sentence(const OptionRow& option) {
    std::string text = option.meaning;
    const bool words_told = std::all_of(option.words.begin(), option.words.end(),
                                        [&](const std::string& word) { return text.find(word) != std::string::npos; });
    if (option.kind == ValueKind::words && !words_told)
        text += fmt::format("; one of {}", fmt::join(option.words, " "));
    if (!option.range.empty() && text.find(option.range) == std::string::npos)
        text += fmt::format("; {}", option.range);
    if (option.repeatable && text.find("repeatable") == std::string::npos) text += "; repeatable";
    if (option.required && !option.positional()) text += "; needed";
    return text;
}

std::vector<CommandRow> option_table(const CLI::App& program) {
    std::vector<CommandRow> table;
    for (const CLI::App* command : program.get_subcommands(nullptr))
        table.push_back(command_row(*command, ""));
    return table;
}

}  // namespace skyloop::host
