#include "run/scenario/key_catalogue.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <tuple>

#include "detail/scenario_keys.hpp"
#include "detail/table_reader.hpp"

namespace skyloop::inline run {
namespace {

struct UnitSuffix {
    std::string_view suffix, unit;
};
// Longer ones first where one ends another.
constexpr std::array<UnitSuffix, 43> unit_suffixes{{{"_db_per_km_per_g_m3", "dB/km per g/m³"},
                                                    {"_db_per_km", "dB/km"},
                                                    {"_db_per_m", "dB/m"},
                                                    {"_kg_per_mol", "kg/mol"},
                                                    {"_j_per_mol_k", "J/(mol K)"},
                                                    {"_ns_per_s", "ns/s"},
                                                    {"_s_per_s", "s/s"},
                                                    {"_bytes_per_s", "bytes/s"},
                                                    {"_slips_per_minute", "1/min"},
                                                    {"slips_per_minute", "1/min"},
                                                    {"slips_per_hour", "1/h"},
                                                    {"bursts_per_s", "1/s"},
                                                    {"bytes_per_s", "bytes/s"},
                                                    {"_mm_per_km", "mm/km"},
                                                    {"_mm_h", "mm/h"},
                                                    {"_g_m3", "g/m³"},
                                                    {"_per_k", "1/K"},
                                                    {"_per_m", "1/m"},
                                                    {"_per_s", "1/s"},
                                                    {"_dbw_hz", "dBW/Hz"},
                                                    {"_dbhz", "dB-Hz"},
                                                    {"_dbic", "dBic"},
                                                    {"_dbw", "dBW"},
                                                    {"_db", "dB"},
                                                    {"_ghz2", "GHz²"},
                                                    {"_hz", "Hz"},
                                                    {"_mps2", "m/s²"},
                                                    {"_mps", "m/s"},
                                                    {"_tecu", "TECU"},
                                                    {"_chips", "chips"},
                                                    {"_cycles", "cycles"},
                                                    {"_bytes", "bytes"},
                                                    {"_hpa", "hPa"},
                                                    {"_deg", "°"},
                                                    {"_rad", "rad"},
                                                    {"_km", "km"},
                                                    {"_mb", "MB"},
                                                    {"_ns", "ns"},
                                                    {"_us", "µs"},
                                                    {"_m", "m"},
                                                    {"_s", "s"},
                                                    {"_k", "K"},
                                                    {"_h", "h"}}};

// Kinds that are all there are say nothing; of those that this version refuses nothing is said.
void tidy_kinds(std::vector<std::string>& kinds, const std::vector<std::string>& all) {
    std::erase_if(kinds, [&](const std::string& kind) { return std::find(all.begin(), all.end(), kind) == all.end(); });
    if (kinds.size() == all.size()) kinds.clear();
}

template <class Item>
void tidy_items(std::vector<Item>& items, const std::vector<std::string>& all) {
    std::erase_if(items, [&](Item& item) {
        const bool had_kinds = !item.kinds.empty();
        const bool of_refused_only =
            had_kinds && std::none_of(item.kinds.begin(), item.kinds.end(),
                                      [&](const auto& k) { return std::find(all.begin(), all.end(), k) != all.end(); });
        tidy_kinds(item.kinds, all);
        return of_refused_only;
    });
}

}  // namespace

const std::vector<KeyTable>& scenario_key_tables() {
    static const std::vector<KeyTable> tables = [] {
        KeyRecorder recorder;
        const toml::table nothing;
        MistakeList mistakes("keys");  // of readers that find nothing; nobody sees them
        for (const bool given : {false, true}) {
            recorder.begin(given);
            Scenario scenario;
            recorder.record({}, false, [&] {
                TableReader top(nothing, {}, mistakes, &recorder);
                read_top_keys(top, scenario, {});
            });
        }
        return recorder.tables();
    }();
    return tables;
}

const KeyEntry& scenario_key(std::string_view path, std::string_view kind) {
    const std::size_t dot = path.rfind('.');
    std::string_view table = path.substr(0, dot);
    // Of lists, the place of the entry.
    if (const std::size_t place = table.rfind('.');
        place != table.npos && table.find_first_not_of("0123456789", place + 1) == table.npos)
        table = table.substr(0, place);
    for (const KeyTable& known : scenario_key_tables())
        for (const KeyEntry& key : known.keys) {
            const bool of_kind = kind.empty() || std::find(key.kinds.begin(), key.kinds.end(), kind) != key.kinds.end();
            if (known.path == table && key.name == path.substr(dot + 1) && of_kind) return key;
        }
    throw std::out_of_range(std::string(path));
}

std::string_view key_unit(std::string_view key) {
    if (key == "ppm") return "ppm";
    const auto* const found = std::find_if(unit_suffixes.begin(), unit_suffixes.end(),
                                           [&](const UnitSuffix& unit) { return key.ends_with(unit.suffix); });
    return found == unit_suffixes.end() ? std::string_view() : found->unit;
}

bool KeyEntry::same_as(const KeyEntry& other) const {
    const auto parts = [](const KeyEntry& k) {
        return std::tie(k.name, k.type, k.least, k.most, k.count_least, k.count_most, k.choices, k.standard, k.needed,
                        k.meaning);
    };
    return parts(*this) == parts(other);
}

void KeyRecorder::record(const std::string& path, bool list, const std::function<void()>& body) {
    Noted& noted = noted_[path];
    noted.table.path = path;
    noted.table.list = list;
    noted.kind.clear();
    noted.names_kinds = false;
    body();
    const std::vector<std::string> words = noted.words;
    for (const std::string& word : words) {
        noted.kind = word;
        body();
    }
}

void KeyRecorder::note(const std::string& path, KeyEntry entry) {
    Noted& noted = noted_[path];
    if (noted.is_waiting()) return;
    if (given_ && std::find(noted.order.begin(), noted.order.end(), entry.name) == noted.order.end())
        noted.order.push_back(entry.name);
    if (noted.seen.contains({"", entry.name}) || !noted.seen.emplace(noted.kind, entry.name).second) return;
    auto& keys = noted.table.keys;
    auto at = std::find_if(keys.begin(), keys.end(), [&](const KeyEntry& other) { return other.same_as(entry); });
    if (at == keys.end()) at = keys.insert(keys.end(), std::move(entry));
    if (!noted.kind.empty()) at->kinds.push_back(noted.kind);
}

void KeyRecorder::add_rule(std::vector<KeyRule>& rules, const Noted& noted, KeyRule rule) {
    if (noted.is_waiting()) return;
    auto at = std::find_if(rules.begin(), rules.end(), [&](const KeyRule& other) { return other.keys == rule.keys; });
    if (at == rules.end()) at = rules.insert(rules.end(), std::move(rule));
    if (!noted.kind.empty() && std::find(at->kinds.begin(), at->kinds.end(), noted.kind) == at->kinds.end())
        at->kinds.push_back(noted.kind);
}

void KeyRecorder::note_one_of(const std::string& path, std::initializer_list<std::string_view> keys) {
    Noted& noted = noted_[path];
    add_rule(noted.table.one_of, noted, {{keys.begin(), keys.end()}, {}});
}

void KeyRecorder::note_not_both(const std::string& path, std::string_view key, std::string_view other) {
    Noted& noted = noted_[path];
    add_rule(noted.table.not_both, noted, {{std::string(key), std::string(other)}, {}});
}

std::optional<std::size_t> KeyRecorder::kind(const std::string& path, std::span<const std::string_view> words) {
    Noted& noted = noted_[path];
    noted.words.assign(words.begin(), words.end());
    noted.names_kinds = true;
    if (noted.kind.empty()) return std::nullopt;
    return static_cast<std::size_t>(std::find(words.begin(), words.end(), noted.kind) - words.begin());
}

void KeyRecorder::refuse_kind(const std::string& path) {
    Noted& noted = noted_[path];
    if (!noted.kind.empty()) noted.refused.insert(noted.kind);
}

void KeyRecorder::look_for(const std::string& path, std::string_view key) { noted_[path].looked_for.emplace(key); }

KeyTable KeyRecorder::finished(const Noted& noted) {
    KeyTable table = noted.table;
    for (const std::string& word : noted.words)
        if (!noted.refused.contains(word)) table.kinds.push_back(word);
    if (!noted.words.empty()) {
        tidy_items(table.keys, table.kinds);
        tidy_items(table.one_of, table.kinds);
        tidy_items(table.not_both, table.kinds);
    }
    for (const std::string& key : noted.looked_for)
        if (std::none_of(table.keys.begin(), table.keys.end(), [&](const KeyEntry& k) { return k.name == key; }))
            table.unread.push_back(key);
    for (KeyEntry& key : table.keys) {
        if (key.name == "kind" && !noted.words.empty()) key.choices = table.kinds;
        // An alternative of one key is a key that is needed.
        for (const KeyRule& rule : table.one_of)
            if (rule.keys == std::vector<std::string>{key.name} && rule.kinds == key.kinds) key.needed = true;
        if (key.needed) key.standard.reset();
    }
    const auto place = [&](const KeyEntry& key) { return std::find(noted.order.begin(), noted.order.end(), key.name); };
    std::stable_sort(table.keys.begin(), table.keys.end(),
                     [&](const KeyEntry& a, const KeyEntry& b) { return place(a) < place(b); });
    std::erase_if(table.one_of, [](const KeyRule& rule) { return rule.keys.size() == 1; });
    return table;
}

void KeyRecorder::add_with_inner(const std::string& path, std::vector<KeyTable>& tables) const {
    const auto noted = noted_.find(path);
    if (noted == noted_.end()) return;
    tables.push_back(finished(noted->second));
    const std::vector<KeyEntry> keys = tables.back().keys;
    for (const KeyEntry& key : keys)
        if (key.type == KeyType::table || key.type == KeyType::tables)
            add_with_inner(path.empty() ? key.name : path + "." + key.name, tables);
}

std::vector<KeyTable> KeyRecorder::tables() const {
    std::vector<KeyTable> tables;
    add_with_inner({}, tables);
    return tables;
}

}  // namespace skyloop::inline run
