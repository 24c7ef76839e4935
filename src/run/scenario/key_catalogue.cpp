#include "run/scenario/key_catalogue.hpp"

#include <algorithm>
#include <array>

#include "detail/key_meanings.hpp"
#include "detail/key_recorder.hpp"
#include "detail/scenario_keys.hpp"

namespace skyloop {
namespace {

void record_scenario(KeyRecorder& recorder) {
    static const toml::table nothing;
    MistakeList mistakes("keys");  // of readers that find nothing; nobody is told
    Scenario scenario;
    recorder.enter({}, false);
    TableReader top(nothing, {}, mistakes, &recorder);
    read_top_keys(top, scenario, {});
}

void add_meanings(std::vector<KeyTable>& tables) {
    for (KeyTable& table : tables)
        for (KeyEntry& key : table.keys) {
            const KeyMeaning* meaning = find_key_meaning(table.path, key.name);
            if (meaning == nullptr) continue;
            key.meaning = meaning->meaning;
            key.standard_words = meaning->standard;
        }
}

struct UnitSuffix {
    std::string_view suffix, unit;
};
// Longer ones first where one ends another.
constexpr std::array<UnitSuffix, 44> unit_suffixes{{{"_m_per_sqrt_h", "m/√h"},
                                                    {"_db_per_km_per_g_m3", "dB/km per g/m³"},
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

}  // namespace

const std::vector<KeyTable>& scenario_key_tables() {
    static const std::vector<KeyTable> tables = [] {
        KeyRecorder recorder;
        for (const bool given : {false, true}) {
            recorder.begin(given, std::nullopt);
            record_scenario(recorder);
        }
        // There are more of them when a table is found that only one kind has.
        for (std::size_t turn = 0; turn < recorder.turns(); ++turn)
            for (const bool given : {false, true}) {
                recorder.begin(given, turn);
                record_scenario(recorder);
            }
        std::vector<KeyTable> noted = recorder.tables();
        add_meanings(noted);
        return noted;
    }();
    return tables;
}

std::vector<std::string> words_without_key() {
    std::vector<std::string> lost;
    for (const auto meanings : {run_key_meanings(), model_key_meanings(), modern_key_meanings()})
        for (const KeyMeaning& meaning : meanings) {
            bool used = false;
            for (const KeyTable& table : scenario_key_tables())
                for (const KeyEntry& key : table.keys)
                    used |= find_key_meaning(table.path, key.name) == &meaning;
            if (!used) lost.push_back(std::string(meaning.table) + "." + std::string(meaning.key));
        }
    return lost;
}

std::string_view key_unit(std::string_view key) {
    if (key == "ppm") return "ppm";
    const auto* const found = std::find_if(unit_suffixes.begin(), unit_suffixes.end(),
                                           [&](const UnitSuffix& unit) { return key.ends_with(unit.suffix); });
    return found == unit_suffixes.end() ? std::string_view() : found->unit;
}

}  // namespace skyloop
