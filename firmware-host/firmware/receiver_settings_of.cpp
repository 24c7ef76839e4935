#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "firmware/config/legacy_keys.hpp"
#include "firmware/config/signal_keys.hpp"
#include "firmware/messages/field_values.hpp"
#include "firmware/receiver_core.hpp"

namespace skyloop::firmware {
namespace {

bool signals_changed(const ConfigStore& store) {
    const auto changed = [&](std::uint32_t id) {
        return store.has(id) && store.stored(ConfigLayer::factory, id) != store.value(id);
    };
    return std::ranges::any_of(system_keys_of_signals, [&](const auto& s) { return changed(s.enable); }) ||
           std::ranges::any_of(signal_keys, [&](const auto& s) { return changed(s.enable); });
}

bool is_changed(const ConfigStore& store, std::uint32_t id) {
    return store.has(id) && store.stored(ConfigLayer::factory, id) != store.value(id);
}

// What a client has chosen. Signals of the scenario (`dual_frequency`) that the board has no item for, so that no
// client can speak of them, stay for as long as their system is on.
std::set<SystemSignal> chosen_signals(const ConfigStore& store, const std::set<SystemSignal>& scenario) {
    std::set<SystemSignal> chosen = enabled_signals(store);
    const auto has_item = [&](const SystemSignal& signal) {
        return std::ranges::any_of(signal_keys,
                                   [&](const SignalKey& s) { return s.signal == signal && store.has(s.enable); });
    };
    for (const SystemSignal& signal : scenario)
        if (!has_item(signal) && is_enabled(store, signal.constellation)) chosen.insert(signal);
    return chosen;
}

// Measurement and navigation period of the store, made longer by whole measurements until the board can follow.
Nanoseconds navigation_period_of(const ConfigStore& store, const BoardProfile& board) {
    const auto measurement = std::chrono::milliseconds(std::max<std::uint64_t>(1, store.value(key::rate_meas)));
    auto cycles = static_cast<std::int64_t>(std::max<std::uint64_t>(1, store.value(key::rate_nav)));
    // Periods are whole milliseconds. 18 Hz are stored as 56, and asked for as 55 by who leaves the rest of a division
    // out: that must not be half of the rate.
    const auto shortest = std::chrono::milliseconds(static_cast<std::int64_t>(std::floor(1000.0 / board.max_rate_hz)));
    while (cycles * measurement < shortest)
        ++cycles;
    return cycles * measurement;
}

std::uint64_t measurement_period_of(const BoardProfile& board, double rate_hz) {
    constexpr double longest_ms = 65535;  // CFG-RATE measRate is a U2
    const double rate = std::min(rate_hz > 0 ? rate_hz : board.default_rate_hz, board.max_rate_hz);
    return static_cast<std::uint64_t>(std::llround(std::clamp(1000.0 / rate, 1.0, longest_ms)));
}

}  // namespace

// CFG-NAVSPG-DYNMODEL: 9 wrist, 10 bike, 11 mower and 12 e-scooter move about as the nearest of the others.
DynamicModel dynamic_model_of(std::uint64_t number) {
    using enum DynamicModel;
    constexpr std::array models{portable,    stationary,  stationary, pedestrian, automotive, sea,       airborne_1g,
                                airborne_2g, airborne_4g, pedestrian, automotive, pedestrian, pedestrian};
    return number < models.size() ? models[number] : portable;
}

std::uint64_t dynamic_model_number(DynamicModel model) {
    constexpr std::array<std::uint64_t, 8> numbers{0, 2, 3, 4, 5, 6, 7, 8};
    return numbers[static_cast<std::size_t>(model)];
}

ReceiverSettings settings_of(const ConfigStore& store, const BoardProfile& board, const ReceiverSettings& base) {
    ReceiverSettings settings = base;
    settings.navigation_period = navigation_period_of(store, board);
    const double rate = 1e9 / static_cast<double>(settings.navigation_period.count());
    const bool is_fast = board.all_satellites_rate_hz > 0 && rate > board.all_satellites_rate_hz;
    settings.most_satellites = is_fast ? static_cast<std::size_t>(board.fast_satellites) : 0;
    if (board.personality == Personality::ublox) {
        const auto most = static_cast<std::size_t>(std::max<std::uint64_t>(1, store.value(key::navspg_max_svs)));
        settings.most_satellites = is_fast ? std::min(settings.most_satellites, most) : most;
    }
    if (signals_changed(store) || base.signals.empty()) settings.signals = chosen_signals(store, base.signals);
    if (board.personality == Personality::ublox) {
        settings.sbas_scan_mask = store.value(key::sbas_scan_mask);
        settings.sbas_ranging = store.flag(legacy_key::sbas_ranging);
    }
    settings.beidou_b1c = takes_b1c(store);
    if (is_changed(store, key::navspg_min_elev))
        settings.elevation_mask = Angle::degrees(static_cast<double>(store.signed_value(key::navspg_min_elev)));
    settings.minimum_cn0 = DbHz(static_cast<double>(store.value(key::navspg_min_cno)));
    if (is_changed(store, key::navspg_dynmodel))
        settings.dynamic_model = dynamic_model_of(store.value(key::navspg_dynmodel));
    settings.dynamic_limits = board.dynamic_limits;
    settings.airborne_ceiling = airborne_ceiling(board.identity.generation);
    if (is_changed(store, key::mot_speed_threshold))
        settings.static_hold_below =
            MetresPerSecond(static_cast<double>(store.value(key::mot_speed_threshold)) / 100.0);
    settings.course_held_below = board.course_min_speed;
    settings.subframes = false;
    for (const PortId port : board.ports)
        settings.subframes |= store.rate({0x02, 0x13}, port) > 0;
    return settings;
}

ConfigValues initial_config(const BoardProfile& board, const ReceiverOptions& options) {
    ConfigValues values = factory_config(board);
    const auto put = [&](std::uint32_t id, std::uint64_t value) {
        if (const auto found = values.find(id); found != values.end()) found->second = value;
    };
    put(key::rate_meas, measurement_period_of(board, options.rate_hz));
    const ReceiverSettings& s = options.settings;
    put(key::navspg_dynmodel, dynamic_model_number(s.dynamic_model));
    put(key::navspg_min_elev, static_cast<std::uint8_t>(std::lround(s.elevation_mask.deg())));
    const double hold = std::round(s.static_hold_below.value() * 100);
    put(key::mot_speed_threshold, static_cast<std::uint64_t>(std::clamp(hold, 0.0, 255.0)));
    if (s.signals.empty()) return values;
    const auto on = [&](Constellation system) {
        return std::ranges::any_of(s.signals, [&](const SystemSignal& t) { return t.constellation == system; });
    };
    for (const SystemKeys& system : system_keys_of_signals)
        put(system.enable, on(system.constellation));
    constexpr std::uint32_t beidou_b1i = 0x1031000D, beidou_b1c = 0x1031000F;
    std::optional<std::uint64_t> factory_b1i;
    if (const auto found = values.find(beidou_b1i); found != values.end()) factory_b1i = found->second;
    // A system that is off keeps the signals of the factory, with which clients find it when they switch it on.
    for (const SignalKey& signal : signal_keys)
        if (on(signal.signal.constellation)) put(signal.enable, s.signals.contains(signal.signal) ? 1 : 0);
    // Of the two names of one measured signal a receiver that has both has one on, as at the factory.
    if (factory_b1i) put(*factory_b1i != 0 ? beidou_b1c : beidou_b1i, 0);
    return values;
}

std::optional<RefusedOptions> refused_options(const BoardProfile& board, const ReceiverOptions& options) {
    if (board.personality != Personality::ublox) return std::nullopt;
    const ConfigValues values = initial_config(board, options);
    if (const auto* item = first_out_of_range(board, values))
        return RefusedOptions{item->first, fmt::format("{} is {}, which {} itself would refuse",
                                                       find_config_key(item->first)->name, item->second, board.name)};
    if (is_consistent(board, values)) return std::nullopt;
    return RefusedOptions{std::nullopt,
                          board.name +
                              " itself would refuse these systems: none that gives a position, too many, or "
                              "signals that exclude each other"};
}

}  // namespace skyloop::firmware
