#include "firmware/casic/settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "firmware/sentences/sentence_maker.hpp"

namespace skyloop::firmware {
namespace {

// Of dynamic_model_of(), whose number 1 is none.
constexpr std::array<std::uint64_t, 8> models_of_motions{0, 2, 3, 4, 5, 6, 7, 8};
constexpr std::array<Constellation, 3> systems_of_bits{Constellation::gps, Constellation::beidou,
                                                       Constellation::glonass};

}  // namespace

OwnSettings casic_settings(const BoardProfile& board) {
    constexpr std::uint64_t automatic = 3, fewest = 3, most = 32, weakest = 4;
    OwnSettings settings;
    const std::uint64_t version = board.nmea_version >= NmeaVersion::v4_10  ? casic_nmea_4_10
                                  : board.nmea_version >= NmeaVersion::v4_0 ? casic_nmea_4_0
                                                                            : casic_nmea_2_2;
    settings.add(CasicKeys::sentence_version, "sentence_version", version);
    settings.add(CasicKeys::fix_mode, "fix_mode", automatic);
    settings.add(CasicKeys::least_satellites, "least_satellites", fewest);
    settings.add(CasicKeys::most_satellites, "most_satellites", most);
    settings.add(CasicKeys::least_cn0, "least_cn0", weakest);
    settings.add(CasicKeys::least_elevation, "least_elevation",
                 static_cast<std::uint64_t>(std::lround(board.elevation_mask.deg())));
    for (const PortId port : board.ports) {
        const std::string_view name = port_names[static_cast<std::size_t>(port)];
        settings.add(CasicKeys::protocols(port), fmt::format("protocols_{}", name), casic_all_protocols);
        if (is_uart(port)) settings.add(SentenceSettings::baud(port), fmt::format("baud_{}", name), board.baud);
        settings.add(CasicKeys::antenna_text(port), fmt::format("ANT_{}", name), 1);
        for (std::size_t i = 0; i < casic_periodic.size(); ++i)
            settings.add(CasicKeys::rate(i, port), fmt::format("{}_{}", casic_message_name(casic_periodic[i]), name),
                         0);
    }
    return settings;
}

bool set_casic_systems(SentenceSettings& store, std::uint64_t bits) {
    if (bits == 0 || bits >= 1U << systems_of_bits.size()) return false;
    std::vector<std::pair<Constellation, bool>> wanted;
    for (std::size_t i = 0; i < systems_of_bits.size(); ++i)
        wanted.emplace_back(systems_of_bits[i], (bits >> i & 1) != 0);
    if (!store.can_have(wanted)) return false;
    for (const auto& [system, on] : wanted)
        store.set(in_ram, SentenceSettings::system(system), on);
    return true;
}

std::uint64_t casic_systems(const SentenceSettings& store) {
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < systems_of_bits.size(); ++i)
        if (store.flag(SentenceSettings::system(systems_of_bits[i]))) bits |= std::uint64_t{1} << i;
    return bits;
}

bool set_casic_motion(SentenceSettings& store, std::uint64_t number) {
    if (number >= models_of_motions.size()) return false;
    store.set(in_ram, SentenceSettings::dynamic_model, models_of_motions[number]);
    return true;
}

std::uint64_t casic_motion(const SentenceSettings& store) {
    const auto* const found = std::ranges::find(models_of_motions, store.value(SentenceSettings::dynamic_model));
    return found == models_of_motions.end() ? 0 : static_cast<std::uint64_t>(found - models_of_motions.begin());
}

bool set_casic_speed(SentenceSettings& store, const BoardProfile& board, PortId port, std::uint64_t baud) {
    if (!is_uart(port) || !takes_baud(board, baud)) return false;
    store.set(in_ram, SentenceSettings::baud(port), baud);
    return true;
}

bool set_casic_interval(SentenceSettings& store, const BoardProfile& board, std::uint64_t period_ms) {
    constexpr std::array<std::uint64_t, 5> intervals{100, 200, 250, 500, 1000};
    const bool known = std::ranges::find(intervals, period_ms) != intervals.end();
    if (!known || !can_fix_each(board, period_ms)) return false;
    store.set(in_ram, SentenceSettings::fix_interval_ms, period_ms);
    return true;
}

void save_casic(SentenceSettings& store) {
    for (const auto& [item, value] : store.values(ConfigLayer::ram))
        store.keep(item, value);
}

}  // namespace skyloop::firmware
