#include "run/scenario/key_catalogue.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "detail/key_recorder.hpp"
#include "detail/scenario_keys.hpp"

namespace skyloop {
namespace {

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

}  // namespace skyloop
