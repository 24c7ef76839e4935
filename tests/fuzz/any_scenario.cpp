#include "any_scenario.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string_view>

namespace skyloop {
namespace {

constexpr std::array<std::string_view, 4> tables_beyond{"output", "campaign", "scene", "frame"};
// With them a run would read files, open devices or wait for others.
constexpr std::array<std::string_view, 15> keys_beyond{"sky.navigation",
                                                       "model.modern.ionosphere.maps",
                                                       "model.modern.link.satellite_table",
                                                       "model.modern.link.antenna_table",
                                                       "receiver.port",
                                                       "receiver.power",
                                                       "receiver.state_file",
                                                       "trajectory.path",
                                                       "trajectory.source",
                                                       "receiver.trajectory.path",
                                                       "receiver.trajectory.source",
                                                       "run.start",
                                                       "run.speed",
                                                       "run.duration_s",
                                                       "expect.command"};
constexpr std::array<std::string_view, 3> kinds_beyond{"file", "live", "sequence"};

// Drawn within the time that a fuzzer has.
constexpr std::array<std::string_view, 5> times_of_run{"at_s", "for_s", "between_s", "ramp_in_s", "ramp_out_s"};
constexpr double run_s = 8;
// Chosen more often than the many tables of the models.
constexpr std::array<std::string_view, 8> favourites{"fault", "fault",  "receiver", "trajectory",
                                                     "model", "expect", "command",  "sky"};

constexpr std::string_view boards[] = {"ublox-m8",       "ublox-6",      "ublox-m9",          "ublox-m10",
                                       "ublox-f9p",      "nmea-generic", "mtk3339",           "airoha-ag33xx",
                                       "septentrio-sbf", "msp-gps",      "mavlink-gps-input", "ublox-f10"};
constexpr std::string_view instants[] = {"2026-03-01T12:00:03Z", "2024-03-09T23:59:41Z", "2016-12-31T23:59:58Z",
                                         "2019-04-06T23:59:41Z", "2024-02-28T23:59:58Z", "2038-11-20T23:59:43Z"};
constexpr std::string_view receivers[] = {"receiver0", "receiver1"};
constexpr std::string_view entries[] = {"f0", "f1", "f2", "f3"};
constexpr std::string_view messages[] = {"NAV-PVT", "GGA", "CFG-VALSET", "MON-VER", "CFG-MSG", "UBX-0A-04"};
constexpr std::string_view satellites[] = {"G07", "E11", "R01", "G01", "G33", "C05"};
constexpr std::string_view config_items[] = {"CFG-RATE-MEAS", "CFG-ITFM-ENABLE", "CFG-UART1-BAUDRATE"};
constexpr std::string_view modes[] = {"AUTO", "RTL", "LOITER", "POSCTL"};
constexpr std::string_view sentences[] = {"fix",
                                          "no fix within 2 s of f0",
                                          "horizontal error below 5 m throughout f0",
                                          "C/N0 of G07 above 30 dBHz from 1 s to 5 s",
                                          "client reconfigures after f1 for 3 s",
                                          "receiver sends NAV-PVT every 1 s",
                                          "never satellites at least 40",
                                          "jamming flagged at 4 s"};
constexpr std::string_view others[] = {"rover", "EXT CORE 3.01", "nothing"};

// What texts of a key mean something to its reader.
std::span<const std::string_view> texts_of(std::string_view key) {
    static const std::map<std::string_view, std::span<const std::string_view>> known{{"board", boards},
                                                                                     {"receiver", receivers},
                                                                                     {"base", receivers},
                                                                                     {"after", entries},
                                                                                     {"after_end_of", entries},
                                                                                     {"fault", entries},
                                                                                     {"at_utc", instants},
                                                                                     {"messages", messages},
                                                                                     {"when_client_sends", messages},
                                                                                     {"satellites", satellites},
                                                                                     {"keys", config_items},
                                                                                     {"when_mavlink_mode", modes},
                                                                                     {"mode", modes},
                                                                                     {"what", sentences}};
    const auto found = known.find(key);
    return found == known.end() ? others : found->second;
}

constexpr std::string_view places[] = {"at", "to", "rebroadcast_at", "jammer_at"};

template <class List>
bool holds(const List& list, std::string_view word) {
    return std::find(std::begin(list), std::end(list), word) != std::end(list);
}

std::string quoted(std::string_view text) { return fmt::format("\"{}\"", text); }

double between(double least, double most, double share) {
    const bool wide = least >= 0 && most > 1000 * std::max(least, 1e-3);
    if (!wide) return least + share * (most - least);
    const double lowest = std::log(std::max(least, most * 1e-9));
    return std::exp(lowest + share * (std::log(most) - lowest));
}

// At a limit, nothing, one, or in between; of what has no limits up to a million.
double number_of(const KeyEntry& key, FuzzInput& input) {
    constexpr double unlimited = 1e300, large = 1e6;
    const double least = key.least < -unlimited ? -large : key.least;
    const double most = holds(times_of_run, key.name) ? run_s : key.most > unlimited ? large : key.most;
    const std::array<double, 4> marks{least, most, std::clamp(0.0, least, most), std::clamp(1.0, least, most)};
    const std::uint8_t choice = input.byte();
    const double value = choice < 64 ? marks[choice % marks.size()] : between(least, most, input.word() / 65535.0);
    return key.type == KeyType::whole_number || key.type == KeyType::whole_numbers ? std::round(value) : value;
}

std::string number_text(const KeyEntry& key, FuzzInput& input) {
    const double value = number_of(key, input);
    const bool whole = key.type == KeyType::whole_number || key.type == KeyType::whole_numbers;
    if (whole) return fmt::format("{:.0f}", std::clamp(value, -9e18, 9e18));
    std::string text = fmt::format("{}", value);
    if (text.find_first_of(".e") == std::string::npos) text += ".0";
    return text;
}

template <class Words>
std::string word_of(const Words& words, FuzzInput& input) {
    return quoted(words[input.byte() % std::size(words)]);
}

template <class Item>
std::string list_of(const KeyEntry& key, FuzzInput& input, const Item& item) {
    constexpr std::size_t most = 6;
    const std::size_t least = std::max<std::size_t>(key.count_least, 1);
    const std::size_t count = std::min(key.count_most, least + input.byte() % most);
    std::vector<std::string> items;
    for (std::size_t i = 0; i < count; ++i)
        items.push_back(item());
    return fmt::format("[{}]", fmt::join(items, ", "));
}

std::string place_of(FuzzInput& input) {
    constexpr std::array<double, 6> heights{0, 50, -400, 9000, 30000, 400000};
    const double latitude = between(-90, 90, input.word() / 65535.0),
                 longitude = between(-180, 180, input.word() / 65535.0);
    return fmt::format("[{:.9f}, {:.9f}, {:.1f}]", latitude, longitude, heights[input.byte() % heights.size()]);
}

// Two times of the run in order.
std::string span_of(FuzzInput& input) {
    const double first = between(0, run_s, input.word() / 65535.0);
    return fmt::format("[{:.3f}, {:.3f}]", first, first + between(0, run_s, input.word() / 65535.0));
}

// About the default place, or elsewhere.
std::string area_of(FuzzInput& input) {
    const double reach = between(1e-5, 60, input.word() / 65535.0);
    return fmt::format("[[{0}, 30.0], [{1}, 30.0], [{1}, 31.0]]", 46.5 - reach / 2, 46.5 + reach / 2);
}

std::string words_of(const KeyEntry& key, FuzzInput& input) {
    std::vector<std::string> chosen;
    const std::uint16_t mask = input.word() | (key.name == "constellations" ? 1U : 0U);  // the nominal sky is GPS
    for (std::size_t i = 0; i < key.choices.size(); ++i)
        if ((mask >> i % 16 & 1U) != 0) chosen.push_back(quoted(key.choices[i]));
    if (chosen.empty()) chosen.push_back(quoted(key.choices.at(0)));
    return fmt::format("[{}]", fmt::join(chosen, ", "));
}

// Empty: not for us.
std::string value_of(const KeyEntry& key, FuzzInput& input) {
    switch (key.type) {
        case KeyType::number:
        case KeyType::whole_number:
            return number_text(key, input);
        case KeyType::flag:
            return input.byte() % 2 == 1 ? "true" : "false";
        case KeyType::time:
            return word_of(instants, input);
        case KeyType::word:
            return word_of(key.choices, input);
        case KeyType::words:
        case KeyType::word_or_words:
            return words_of(key, input);
        case KeyType::text:
            return word_of(texts_of(key.name), input);
        case KeyType::texts:
        case KeyType::text_or_texts:
            return list_of(key, input, [&] { return word_of(texts_of(key.name), input); });
        case KeyType::numbers:
        case KeyType::whole_numbers:
        case KeyType::number_groups:
            if (key.name == "when_inside") return area_of(input);
            if (holds(places, key.name)) return place_of(input);
            if (key.name.find("between") != std::string::npos) return span_of(input);
            return list_of(key, input, [&] { return number_text(key, input); });
        case KeyType::place:
            return place_of(input);
        default:
            return {};
    }
}

const KeyTable* table_at(std::string_view path) {
    const auto& tables = scenario_key_tables();
    const auto found = std::find_if(tables.begin(), tables.end(), [&](const KeyTable& t) { return t.path == path; });
    return found == tables.end() ? nullptr : &*found;
}

// The node of a table, made with those that it stands in; of each list the element that two bits of `place` name.
ScenarioNode& node_at(ScenarioNode& root, const KeyTable& table, std::uint8_t place) {
    ScenarioNode* node = &root;
    for (std::size_t end = 0; end < table.path.size();) {
        const std::size_t begin = end == 0 ? 0 : end + 1;
        end = std::min(table.path.find('.', begin), table.path.size());
        const KeyTable* const inner = table_at(std::string_view(table.path).substr(0, end));
        std::vector<ScenarioNode>& elements = node->children[table.path.substr(begin, end - begin)];
        const std::size_t index = inner->list ? place & (inner->path == "receiver" ? 1U : 3U) : 0;
        if (inner->list) place = static_cast<std::uint8_t>(place >> 2);
        if (elements.size() <= index) elements.resize(index + 1);
        for (ScenarioNode& element : elements)
            element.table = inner;
        node = &elements[index];
    }
    return *node;
}

bool stands_with(const std::vector<std::string>& kinds, const std::string& kind) {
    return kinds.empty() || holds(kinds, kind);
}

std::vector<const KeyEntry*> keys_of(const KeyTable& table, const std::string& kind) {
    std::vector<const KeyEntry*> keys;
    for (const KeyEntry& key : table.keys)
        if (stands_with(key.kinds, kind)) keys.push_back(&key);
    return keys;
}

const KeyEntry* find_key(const std::vector<const KeyEntry*>& keys, std::string_view name) {
    const auto found = std::find_if(keys.begin(), keys.end(), [&](const KeyEntry* key) { return key->name == name; });
    return found == keys.end() ? nullptr : *found;
}

void choose_kind(ScenarioNode& node, FuzzInput& input) {
    const KeyEntry* const key = find_key(keys_of(*node.table, {}), "kind");
    if (key == nullptr || key->choices.empty()) return;
    std::string& kind = node.values["kind"];
    if (kind.empty()) kind = word_of(key->choices, input);
    if (holds(kinds_beyond, node.kind())) kind = quoted(key->choices.front());
}

// What must be there, and of what may not stand together the first.
void keep_rules(ScenarioNode& node, FuzzInput& input) {
    const std::string kind = node.kind();
    const std::vector<const KeyEntry*> keys = keys_of(*node.table, kind);
    std::erase_if(node.values, [&](const auto& value) { return find_key(keys, value.first) == nullptr; });
    const auto give = [&](const KeyEntry* key) {
        if (key != nullptr && !node.values.contains(key->name))
            if (std::string value = value_of(*key, input); !value.empty()) node.values[key->name] = std::move(value);
    };
    for (const KeyEntry* key : keys)
        if (key->needed) give(key);
    const auto there = [&](const std::string& name) { return node.values.contains(name); };
    for (const KeyRule& rule : node.table->one_of)
        if (stands_with(rule.kinds, kind) && std::none_of(rule.keys.begin(), rule.keys.end(), there))
            give(find_key(keys, rule.keys.front()));
    for (const KeyRule& rule : node.table->not_both) {
        const auto first = std::find_if(rule.keys.begin(), rule.keys.end(), there);
        for (auto other = first; stands_with(rule.kinds, kind) && other != rule.keys.end(); ++other)
            if (other != first) node.values.erase(*other);
    }
}

void give_corners(ScenarioNode& node) {
    std::vector<ScenarioNode>& corners = node.children["waypoint"];
    if (corners.size() < 2) corners.resize(2);
    for (ScenarioNode& corner : corners)
        corner.table = table_at(node.table->path + ".waypoint");
}

// What a reader asks for beyond its table.
void make_plausible(ScenarioNode& node) {
    const std::string kind = node.kind();
    if (kind == "waypoints") give_corners(node);
    if (kind == "spoof_takeover") node.values.emplace("offset_m", "[300.0, 0.0, 0.0]");
    if (kind == "start_fault" || kind == "stop_fault") node.values.emplace("fault", quoted(entries[0]));
    if (node.table->path == "atmosphere.layer") node.values["base_m"] = "0.0", node.values["top_m"] = "1500.0";
    if (node.values.contains("times")) node.values.emplace("every_s", "2.0");
    if (node.table->path == "receiver" || node.table->path == "expect") node.values.erase("name");
}

void complete(ScenarioNode& node, FuzzInput& input) {
    if (node.table != nullptr) {
        choose_kind(node, input);
        keep_rules(node, input);
        const std::vector<const KeyEntry*> keys = keys_of(*node.table, node.kind());
        std::erase_if(node.children, [&](const auto& child) { return find_key(keys, child.first) == nullptr; });
        make_plausible(node);
    }
    for (auto& [name, elements] : node.children)
        for (std::size_t i = 0; i < elements.size(); ++i) {
            complete(elements[i], input);
            if (name == "fault") elements[i].values["name"] = quoted(entries[i]);
        }
}

void write(const ScenarioNode& node, std::string& toml) {
    for (const auto& [key, value] : node.values)
        toml += fmt::format("{} = {}\n", key, value);
    for (const auto& [name, elements] : node.children)
        for (const ScenarioNode& element : elements) {
            const std::string_view path = element.table->path;
            toml += element.table->list ? fmt::format("[[{}]]\n", path) : fmt::format("[{}]\n", path);
            write(element, toml);
        }
}

std::string unquoted(const std::string& value) {
    return value.size() >= 2 && value.front() == '"' ? value.substr(1, value.size() - 2) : value;
}

std::set<std::string> values_of(const ScenarioNode& root, const char* table, const char* key) {
    std::set<std::string> values;
    if (const auto found = root.children.find(table); found != root.children.end())
        for (const ScenarioNode& node : found->second)
            if (const auto value = node.values.find(key); value != node.values.end())
                values.insert(unquoted(value->second));
    return values;
}

bool is_beyond(const KeyTable& table) {
    return table.path.empty() || holds(tables_beyond, std::string_view(table.path).substr(0, table.path.find('.')));
}

const KeyTable& any_table(FuzzInput& input) {
    const auto& tables = scenario_key_tables();
    const std::uint8_t choice = input.byte();
    return choice < 128 ? *table_at(favourites[choice % favourites.size()]) : tables[choice % tables.size()];
}

}  // namespace

std::string ScenarioNode::kind() const {
    const auto found = values.find("kind");
    return found == values.end() ? std::string() : unquoted(found->second);
}

AnyScenario::AnyScenario(FuzzInput& input) {
    constexpr int most_keys = 40;
    for (int i = 0; i < most_keys && !input.empty(); ++i) {
        const KeyTable& table = any_table(input);
        const std::uint8_t which = input.byte(), place = input.byte();
        if (is_beyond(table)) continue;
        ScenarioNode& node = node_at(root_, table, place);
        choose_kind(node, input);
        const std::vector<const KeyEntry*> keys = keys_of(table, node.kind());
        if (keys.empty()) continue;
        const KeyEntry& key = *keys[which % keys.size()];
        if (key.name == "kind" || holds(keys_beyond, table.path + "." + key.name)) continue;
        if (std::string value = value_of(key, input); !value.empty()) node.values[key.name] = std::move(value);
    }
    // Commands and expectations speak of these.
    if (root_.children.contains("command") || root_.children.contains("expect"))
        for (const std::uint8_t place : {std::uint8_t{0}, std::uint8_t{1}})
            (void)node_at(root_, *table_at("fault"), place);
    complete(root_, input);
}

std::string AnyScenario::toml() const {
    std::string text;
    write(root_, text);
    return text;
}

std::set<std::string> AnyScenario::faults() const { return values_of(root_, "fault", "kind"); }

std::set<std::string> AnyScenario::boards() const { return values_of(root_, "receiver", "board"); }

}  // namespace skyloop
