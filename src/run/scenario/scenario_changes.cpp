#include "run/scenario/scenario_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "base/core/files.hpp"
#include "base/core/number_text.hpp"
#include "detail/scenario_keys.hpp"
#include "detail/toml_values.hpp"

namespace skyloop::inline run {
namespace {

std::vector<std::string_view> parts_of(std::string_view key) {
    std::vector<std::string_view> parts;
    for (;;) {
        const std::size_t dot = key.find('.');
        parts.push_back(key.substr(0, dot));
        if (dot == std::string_view::npos) return parts;
        key.remove_prefix(dot + 1);
    }
}

// The only entry of a list of tables that has this word under `key`; nothing: none, or several.
std::optional<std::size_t> entry_with(const toml::array& list, std::string_view key, std::string_view word) {
    std::optional<std::size_t> found;
    for (std::size_t i = 0; i < list.size(); ++i) {
        const toml::table* entry = list[i].as_table();
        if (entry == nullptr || (*entry)[key].value<std::string_view>() != word) continue;
        if (found) return std::nullopt;
        found = i;
    }
    return found;
}

// What messages call the entries of a list; those that have no name get one of the program's.
std::vector<std::string> names_in(const toml::array& list, std::string_view list_name) {
    std::vector<std::string> names;
    for (const toml::node& item : list) {
        const toml::table* entry = item.as_table();
        std::string name = entry != nullptr ? (*entry)["name"].value_or(std::string()) : std::string();
        if (name.empty() && list_name == "receiver") name = default_receiver_name(names.size());
        if (name.empty() && entry != nullptr && (list_name == "fault" || list_name == "command"))
            name = default_entry_name((*entry)["kind"].value_or(std::string_view()), names);
        names.push_back(std::move(name));
    }
    return names;
}

// @param list_name what the list is called where it stands: "receiver"
std::optional<std::size_t> place_in_list(const toml::array& list, std::string_view list_name, std::string_view part) {
    if (const auto index = number_in<std::size_t>(part)) return *index < list.size() ? index : std::nullopt;
    if (const auto named = entry_with(list, "name", part)) return named;
    if (const auto only = entry_with(list, "kind", part)) return only;
    const std::vector<std::string> names = names_in(list, list_name);
    const auto called = std::find(names.begin(), names.end(), part);
    return called != names.end() ? std::optional(static_cast<std::size_t>(called - names.begin())) : std::nullopt;
}

// The value below `parent` that a part of a key means; a table that is not there is made. Null: there is none.
// @param name of the parent
toml::node* step_down(toml::node& parent, std::string_view name, std::string_view part) {
    if (toml::table* table = parent.as_table()) {
        if (!table->contains(part)) table->insert(part, toml::table{});
        return table->get(part);
    }
    toml::array* list = parent.as_array();
    const auto index = list != nullptr ? place_in_list(*list, name, part) : std::nullopt;
    return index ? list->get(*index) : nullptr;
}

// @param name of the parent
bool put(toml::node& parent, std::string_view name, std::string_view part, const toml::node& value) {
    if (toml::table* table = parent.as_table())
        return value.visit([&](const auto& concrete) { return table->insert_or_assign(part, concrete), true; });
    toml::array* list = parent.as_array();
    const auto index = list != nullptr ? place_in_list(*list, name, part) : std::nullopt;
    if (!index) return false;
    const auto at = static_cast<std::ptrdiff_t>(*index);
    value.visit([&](const auto& concrete) { list->insert(list->cbegin() + at, concrete); });
    list->erase(list->cbegin() + at + 1);
    return true;
}

bool is_place(std::string_view part) {
    return !part.empty() && part.find_first_not_of("0123456789") == std::string_view::npos;
}

// A list is not made: what its entries would be nobody has said.
bool lacks_list(const toml::node& parent, std::string_view part, std::string_view next) {
    static constexpr std::array<std::string_view, 6> lists{"receiver", "output",  "surroundings",
                                                           "fault",    "command", "expect"};
    const toml::table* table = parent.as_table();
    if (table == nullptr || table->contains(part)) return false;
    return is_place(next) || std::find(lists.begin(), lists.end(), part) != lists.end();
}

// A scenario without [[receiver]] has one all the same.
void make_first_receiver(toml::table& table, const std::vector<std::string_view>& parts) {
    if (parts.size() < 2 || parts[0] != "receiver" || table.contains("receiver")) return;
    if (parts[1] == "0" || parts[1] == default_receiver_name(0)) table.insert("receiver", toml::array{toml::table{}});
}

// @return how much of the key is not there: "receiver.0"; empty: it is changed
std::string apply_change(toml::table& table, const ScenarioChange& change) {
    const std::vector<std::string_view> parts = parts_of(change.key);
    const auto until = [&](std::size_t last) {
        return fmt::format("{}", fmt::join(parts.data(), &parts[last] + 1, "."));
    };
    if (parts.size() > most_key_parts || std::find(parts.begin(), parts.end(), "") != parts.end()) return change.key;
    make_first_receiver(table, parts);
    toml::node* parent = &table;
    for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
        if (lacks_list(*parent, parts[i], parts[i + 1])) return until(i + 1);
        parent = step_down(*parent, i > 0 ? parts[i - 1] : "", parts[i]);
        if (parent == nullptr) return until(i);
    }
    bool done = false;
    const std::string_view name = parts.size() > 1 ? parts[parts.size() - 2] : "";
    with_toml_value(change.value, [&](const toml::node& value) { done = put(*parent, name, parts.back(), value); });
    return done ? std::string() : change.key;
}

// @param with_places of the entries of lists; else, as the reader names the key in its mistakes, without
std::string path_of_change(const toml::table& table, std::string_view key, bool with_places) {
    std::string path;
    const toml::node* node = &table;
    std::string_view name;  // of the node
    for (const std::string_view part : parts_of(key)) {
        const std::string_view list_name = std::exchange(name, part);
        const toml::array* list = node != nullptr ? node->as_array() : nullptr;
        if (list != nullptr) {
            const auto index = place_in_list(*list, list_name, part);
            node = index ? list->get(*index) : nullptr;
            if (with_places) path += index ? fmt::format(".{}", *index) : fmt::format(".{}", part);
            continue;
        }
        path += (path.empty() ? "" : ".") + std::string(part);
        const toml::table* inner = node != nullptr ? node->as_table() : nullptr;
        node = inner != nullptr ? inner->get(part) : nullptr;
    }
    return path;
}

// Where the file says that the key changes; its top where it does not.
toml::source_region place_of_parameter(const toml::table& table, std::string_view key) {
    const toml::array* parameters = table["campaign"]["parameter"].as_array();
    for (std::size_t i = 0; parameters != nullptr && i < parameters->size(); ++i) {
        const toml::table* entry = (*parameters)[i].as_table();
        const toml::node* name = entry != nullptr ? entry->get("key") : nullptr;
        if (name != nullptr && name->value<std::string_view>() == key) return name->source();
    }
    toml::source_region top;
    top.begin = {1, 1};
    return top;
}

}  // namespace

void apply_changes(toml::table& table, MistakeList& mistakes, std::span<const ScenarioChange> changes) {
    for (const ScenarioChange& change : changes) {
        const std::string missing = apply_change(table, change);
        const std::string path = path_of_change(table, change.key, false);
        const auto place = place_of_parameter(table, change.key);
        const bool by_option = !change.option.empty();
        mistakes.changed({path, change.key, change.option, place.begin,
                          by_option ? std::string() : fmt::format("{} = {}", change.key, change.value.toml)});
        if (!missing.empty())
            mistakes.add(by_option ? toml::source_region() : place,
                         fmt::format("{} leads to no key: the scenario has no {}; expected tables, and of a list an "
                                     "entry's place from 0 on, or its name or kind",
                                     by_option ? path + ":" : "'" + change.key + "'", missing));
    }
}

namespace {

// Everything in a table as lines, and what may name a file.
class ContentWalk {
public:
    explicit ContentWalk(std::filesystem::path folder) : folder_(std::move(folder)) {}

    void table(const toml::table& table, const std::string& path) {
        for (const auto& [key, node] : table) {
            const std::string below = path.empty() ? std::string(key.str()) : fmt::format("{}.{}", path, key.str());
            if (below == "campaign.parameter") continue;  // files of values are of the runs that have them
            if (below == "campaign") collect_only_ = true;
            value(node, below);
            if (below == "campaign") collect_only_ = false;
        }
    }
    void changed(const ScenarioChange& change) {
        collect_only_ = true;
        with_toml_value(change.value, [&](const toml::node& node) { value(node, change.key); });
    }
    ScenarioContent content() && {
        content_.files.assign(files_.begin(), files_.end());
        return std::move(content_);
    }

private:
    void value(const toml::node& node, const std::string& path) {
        if (const toml::table* inner = node.as_table()) return table(*inner, path);
        if (const toml::array* list = node.as_array()) {
            for (std::size_t i = 0; i < list->size(); ++i)
                value((*list)[i], fmt::format("{}.{}", path, i));
            return line(path, fmt::format("{} entries", list->size()));
        }
        if (const auto* text = node.as_string()) file(text->get(), path);
        if (const auto text = toml_text(node)) line(path, *text);
    }
    void line(const std::string& path, const std::string& text) {
        if (!collect_only_ && path != "run.seed") content_.keys += fmt::format("{} = {}\n", path, text);
    }
    void file(const std::string& name, const std::string& path) {
        constexpr std::size_t longest = 4096;  // PATH_MAX
        if (name.empty() || name.size() >= longest || name.find('\0') != std::string::npos) return;
        std::error_code none;
        const auto status = std::filesystem::status(folder_ / name, none);
        // Of folders only those of cities hold what a run reads.
        const bool city = path.starts_with("scene.") && std::filesystem::is_directory(status);
        if (std::filesystem::is_regular_file(status) || city) files_.insert(name);
    }

    std::filesystem::path folder_;
    ScenarioContent content_;
    std::set<std::string> files_;
    bool collect_only_ = false;
};

}  // namespace

ScenarioReading read_with_mistakes(std::string_view text, const std::filesystem::path& file,
                                   std::span<const ScenarioChange> changes) {
    ScenarioReading reading;
    Scenario& scenario = reading.scenario;
    scenario.name = file.string();
    scenario.source = text;
    for (const ScenarioChange& change : changes)
        if (change.in_source) scenario.source += fmt::format("\n{} = {}", change.key, change.value.toml);
    const auto read = read_toml(
        text, file.string(), [&](TableReader& top) { read_top_keys(top, scenario, file.parent_path()); },
        [&](toml::table& table, MistakeList& mistakes) { apply_changes(table, mistakes, changes); });
    if (!read) reading.mistakes = read.error();
    return reading;
}

ScenarioReading read_file_with_mistakes(const std::filesystem::path& file, std::span<const ScenarioChange> changes) {
    constexpr std::size_t largest = std::size_t{16} << 20;
    const auto text = read_text_file(file, largest);
    if (!text) return {{}, text.error()};
    return read_with_mistakes(*text, file, changes);
}

Result<Scenario> read_scenario(std::string_view text, const std::filesystem::path& file,
                               std::span<const ScenarioChange> changes) {
    ScenarioReading reading = read_with_mistakes(text, file, changes);
    if (reading.mistakes) return fail(*reading.mistakes);
    return std::move(reading.scenario);
}

Result<ScenarioChange> parse_change(std::string_view text) {
    const std::size_t equals = text.find('=');
    const std::string key(text.substr(0, equals));
    if (equals == std::string_view::npos || key.empty())
        return fail(ErrorCode::usage, fmt::format("'{}': expected KEY=VALUE, such as run.seed=7", text));
    const auto values = parse_campaign_values(text.substr(equals + 1));
    if (!values) return fail(values.error().code, fmt::format("{}: {}", key, values.error().message));
    if (values->size() != 1)
        return fail(ErrorCode::usage, fmt::format("{}: '{}' is {} values; expected one, a list in brackets, or a text "
                                                  "with commas in quotes",
                                                  key, text.substr(equals + 1), values->size()));
    return ScenarioChange{key, values->front()};
}

bool speaks_of(std::string_view sentence, std::string_view key) {
    if (sentence.starts_with('[') || sentence.starts_with('\'')) sentence.remove_prefix(1);
    const std::string_view named = sentence.substr(0, sentence.find_first_of(":]'"));
    return sentence.starts_with(key) || (!named.empty() && key.starts_with(fmt::format("{}.", named)));
}

Result<ScenarioContent> scenario_content(std::string_view text, const std::filesystem::path& file) {
    ContentWalk walk(file.parent_path());
    const auto read = read_toml(
        text, file.string(),
        [](TableReader& top) {
            for (const std::string& key : top.keys())
                top.has_been_read(key);
        },
        [&walk](toml::table& table, MistakeList&) { walk.table(table, {}); });
    if (!read) return fail(read.error());
    return std::move(walk).content();
}

std::string place_of_key(std::string_view text, std::string_view key) {
    try {
        return path_of_change(parsed_toml(text), key, true);
    } catch (const toml::parse_error&) {
        return std::string(key);
    }
}

std::string place_of_parameter(std::string_view text, const std::filesystem::path& file, std::string_view key) {
    try {
        const toml::source_position place = place_of_parameter(parsed_toml(text), key).begin;
        return fmt::format("{}:{}:{}", file.string(), place.line, place.column);
    } catch (const toml::parse_error&) {
        return file.string();
    }
}

std::vector<std::string> files_of_change(const ScenarioChange& change, const std::filesystem::path& file) {
    ContentWalk walk(file.parent_path());
    walk.changed(change);
    return std::move(walk).content().files;
}

}  // namespace skyloop::inline run
