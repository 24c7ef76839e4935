// The page of all keys.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cctype>
#include <map>

#include "base/core/words.hpp"
#include "run/scenario/key_catalogue.hpp"

namespace skyloop::inline run {
namespace {

constexpr double no_limit = std::numeric_limits<double>::max();

// "0 to 90", "above 0", "at least 1"
std::string limits_of(const KeyEntry& key) {
    const bool least = key.least > -no_limit, most = key.most < no_limit;
    const bool above_zero = key.least == std::numeric_limits<double>::min();
    if (above_zero) return most ? fmt::format("above 0, up to {:.10g}", key.most) : "above 0";
    if (least && most) return fmt::format("{:.10g} to {:.10g}", key.least, key.most);
    if (least) return fmt::format("at least {:.10g}", key.least);
    return most ? fmt::format("at most {:.10g}", key.most) : std::string();
}

std::string with_limits(const std::string& words, const KeyEntry& key) {
    const std::string limits = limits_of(key);
    return limits.empty() ? words : words + ", " + limits;
}

std::string count_of(const KeyEntry& key) {
    if (key.count_least == key.count_most) return fmt::format("{} ", key.count_least);
    return key.count_least > 1 ? fmt::format("at least {} ", key.count_least) : std::string();
}

std::string words_of(const KeyEntry& key) { return fmt::format("`{}`", fmt::join(key.choices, "` `")); }

// The kinds of faults have a page of their own.
constexpr std::size_t most_listed_words = 40;

std::string taken_by(const KeyEntry& key) {
    switch (key.type) {
        case KeyType::number:
            return with_limits("number", key);
        case KeyType::whole_number:
            return with_limits("whole number", key);
        case KeyType::flag:
            return "true or false";
        case KeyType::text:
            return "text";
        case KeyType::time:
            return "time";
        case KeyType::word:
            return key.choices.size() > most_listed_words ? "word" : words_of(key);
        case KeyType::words:
            return "list of " + words_of(key);
        case KeyType::word_or_words:
            return "one or a list of " + words_of(key);
        case KeyType::texts:
            return "list of texts";
        case KeyType::text_or_texts:
            return "text, or list of texts";
        case KeyType::numbers:
        case KeyType::number_groups:
            return with_limits(fmt::format("list of {}numbers", count_of(key)), key);
        case KeyType::whole_numbers:
            return with_limits("list of whole numbers", key);
        case KeyType::values:
            return "list of values of the key";
        case KeyType::place:
            return "`[latitude, longitude]` or `[latitude, longitude, height]`, ° and m";
        case KeyType::named_values:
            return "table of names and values";
        case KeyType::table:
            return "table";
        case KeyType::tables:
            return key.count_least > 0 ? fmt::format("at least {} tables", key.count_least) : "tables";
    }
    return "";
}

std::string standard_of(const ParameterValue& value) {
    if (const auto* number = std::get_if<double>(&value)) return fmt::format("{:.10g}", *number);
    if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
    if (const auto* text = std::get_if<std::string>(&value)) return fmt::format("`\"{}\"`", *text);
    if (const auto* numbers = std::get_if<std::vector<double>>(&value)) {
        std::vector<std::string> texts;
        for (const double number : *numbers)
            texts.push_back(fmt::format("{:.10g}", number));
        return fmt::format("[{}]", fmt::join(texts, ", "));
    }
    return fmt::format("[\"{}\"]", fmt::join(std::get<std::vector<std::string>>(value), "\", \""));
}

std::string default_of(const KeyEntry& key) {
    if (key.needed) return "needed";
    if (!key.standard_words.empty()) return key.standard_words;
    return key.standard ? standard_of(*key.standard) : "none";
}

std::string key_row(const KeyEntry& key) {
    const std::string_view unit = key_unit(key.name);
    const std::string kinds = key.kinds.empty() ? std::string() : fmt::format("`{}`: ", fmt::join(key.kinds, "`, `"));
    return fmt::format("| `{}` | {} | {} | {} | {}{} |\n", key.name, unit, taken_by(key), default_of(key), kinds,
                       key.meaning);
}

bool is_heading(const KeyEntry& key) { return key.type == KeyType::table || key.type == KeyType::tables; }

std::string rules_of(const KeyTable& table) {
    std::string sentences;
    const auto with = [](const KeyRule& rule) {
        return rule.kinds.empty() ? std::string() : fmt::format(" with `{}`", fmt::join(rule.kinds, "`, `"));
    };
    for (const KeyRule& rule : table.one_of)
        sentences += fmt::format("One of `{}` is needed{}. ", fmt::join(rule.keys, "`, `"), with(rule));
    std::map<std::string, std::vector<std::string>> apart;
    for (const KeyRule& rule : table.not_both)
        apart[rule.keys.front()].push_back(rule.keys.back());
    for (const auto& [key, others] : apart)
        sentences += fmt::format("`{}` does not stand beside `{}`. ", key, fmt::join(others, "`, `"));
    if (sentences.empty()) return sentences;
    sentences.back() = '\n';
    return sentences + "\n";
}

// Keys of single faults and commands stand on their own page.
bool listed(const KeyTable& table, const KeyEntry& key) {
    const bool elsewhere = table.path == "fault" || (table.path == "command" && key.name != "receiver");
    return !is_heading(key) && !(elsewhere && !key.kinds.empty());
}

std::string table_part(const KeyTable& table, std::string_view heading, std::string meaning) {
    if (!meaning.empty()) meaning.front() = upper_case(meaning.front());
    std::string part =
        fmt::format("## {0}{1}{2}\n\n{3}.\n\n", table.list ? "[[" : "[", heading, table.list ? "]]" : "]", meaning);
    std::string rows;
    for (const KeyEntry& key : table.keys)
        if (listed(table, key)) rows += key_row(key);
    if (!rows.empty()) part += "| key | unit | takes | default | meaning |\n|---|---|---|---|---|\n" + rows + "\n";
    if (table.path == "fault" || table.path == "command")
        part += "What each kind takes besides stands in [faults.md](faults.md).\n\n";
    return part + rules_of(table);
}

constexpr std::string_view terms_path = "model.modern.terms";

// The tables of all terms are alike: one stands for them.
std::string terms_part(const KeyTable& terms, const KeyTable& one) {
    std::string part = table_part(one, std::string(terms_path) + ".NAME", "A cause of error, NAME being one of these");
    part += "| NAME | meaning |\n|---|---|\n";
    for (const KeyEntry& term : terms.keys)
        part += fmt::format("| `{}` | {} |\n", term.name, term.meaning);
    return part + "\n";
}

std::string meaning_of(const std::vector<KeyTable>& tables, const KeyTable& table) {
    const std::size_t dot = table.path.rfind('.');
    const std::string above = dot == std::string::npos ? std::string() : table.path.substr(0, dot);
    const std::string name = dot == std::string::npos ? table.path : table.path.substr(dot + 1);
    for (const KeyTable& other : tables)
        if (other.path == above)
            for (const KeyEntry& key : other.keys)
                if (key.name == name) return key.meaning;
    return "";
}

}  // namespace

std::string key_help(const KeyEntry& key) {
    std::string text = key.meaning;
    text.front() = upper_case(text.front());
    if (const std::string_view unit = key_unit(key.name); !unit.empty()) text += fmt::format(", {}", unit);
    if (const std::string limits = limits_of(key); !limits.empty()) text += "; " + limits;
    if (const std::string standard = default_of(key); standard != "none" && standard != "needed")
        text += "; default " + standard;
    std::erase(text, '`');
    return text;
}

std::string scenario_keys_markdown() {
    std::string page =
        "# Every key of a scenario\n\nWritten by `skyloop schema --format markdown`, from what the readers ask for; "
        "what the keys do together stands in [scenario.md](scenario.md). A table that is left out has the defaults of "
        "its keys. \"needed\" is meant where the table is there.\n\n";
    const auto& tables = scenario_key_tables();
    const KeyTable* terms = nullptr;
    for (const KeyTable& table : tables) {
        if (table.path.empty()) continue;
        if (table.path == terms_path) {
            terms = &table;
        } else if (!table.path.starts_with(std::string(terms_path) + ".")) {
            page += table_part(table, table.path, meaning_of(tables, table));
        } else if (terms != nullptr) {
            page += terms_part(*terms, table);
            terms = nullptr;
        }
    }
    page.pop_back();  // one newline at the end
    return page;
}

}  // namespace skyloop::inline run
