#include "run_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>

#include "run/scenario/key_catalogue.hpp"

namespace skyloop::host {

void KeyOptions::add(CLI::App& command, const std::string& option, const std::string& key, std::string_view kind,
                     std::string_view more) {
    const KeyEntry& entry = scenario_key(key, kind);
    Row& row = rows_.emplace_back(Row{option, key, entry.type == KeyType::number && more.empty()});
    row.text = entry.type == KeyType::text;
    CLI::Option* added = command.add_option(option, row.typed, key_help(entry) + std::string(more));
    if (row.number) added->type_name("FLOAT");
    if (entry.type == KeyType::word) added->type_name(fmt::format("TEXT:{{{}}}", fmt::join(entry.choices, ",")));
}

void KeyOptions::add_flag(CLI::App& command, const std::string& option, const std::string& key, const std::string& toml,
                          const std::string& help) {
    Row& row = rows_.emplace_back(Row{option, key, false, false, toml});
    command.add_flag_callback(
        option, [&row] { row.typed = row.toml; }, help);
}

std::string_view KeyOptions::typed(std::string_view option) const {
    const auto row = std::find_if(rows_.begin(), rows_.end(), [&](const Row& each) { return each.option == option; });
    return row == rows_.end() ? std::string_view() : row->typed;
}

std::vector<ScenarioChange> KeyOptions::changes() const {
    std::vector<ScenarioChange> changes;
    for (const Row& row : rows_) {
        if (row.typed.empty()) continue;
        double number = 0;
        const char* end = row.typed.data() + row.typed.size();
        const bool is_number =
            row.toml.empty() && !row.text && std::from_chars(row.typed.data(), end, number).ptr == end;
        const std::string toml = !row.toml.empty() ? row.toml
                                 : is_number       ? campaign_value(number).toml
                                                   : quoted_value(row.typed).toml;
        changes.push_back(change_of(row.option, row.key, toml));
    }
    return changes;
}

std::string KeyOptions::computing() const {
    std::string text;
    for (const Row& row : rows_)
        if (!row.typed.empty() && row.key != "run.speed" && row.key != "receiver.0.power" &&
            row.key != "receiver.0.corrections" && row.key != "caster.listen")
            text += fmt::format("\n{}{}", row.option, row.toml.empty() ? " " + row.typed : "");
    return text;
}

void declare_as_key(CLI::Option& option, const std::string& key, std::string_view kind) {
    const KeyEntry& entry = scenario_key(key, kind);
    option.description(key_help(entry));
    if (entry.type == KeyType::word)
        option.check(CLI::IsMember(entry.choices));
    else
        option.check(CLI::Range(entry.least, entry.most));
}

ScenarioChange change_of(std::string_view option, std::string_view key, std::string toml) {
    ScenarioChange change;
    change.key = key;
    change.value = {toml, toml};
    change.option = option;
    change.in_source = false;  // the caller adds what was typed
    return change;
}

std::string toml_list(const std::vector<std::string>& texts) {
    std::string list;
    for (const std::string& text : texts)
        list += (list.empty() ? "" : ", ") + quoted_value(text).toml;
    return "[" + list + "]";
}

}  // namespace skyloop::host
