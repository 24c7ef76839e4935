// Items of u-blox and the settings of measurement and solution, both ways.
#include <algorithm>
#include <array>
#include <cmath>

#include "firmware/core/factory_settings.hpp"
#include "firmware/core/state_tracker.hpp"
#include "firmware/ublox/config/config_handler.hpp"
#include "firmware/ublox/config/legacy_keys.hpp"
#include "firmware/ublox/config/signal_keys.hpp"

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

// B1C and not B1I.
bool takes_b1c(const ConfigStore& store) {
    constexpr std::uint32_t beidou_enabled = 0x10310022, beidou_b1i = 0x1031000D, beidou_b1c = 0x1031000F;
    return store.flag(beidou_enabled) && store.flag(beidou_b1c) && !store.flag(beidou_b1i);
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

}  // namespace

ReceiverSettings settings_of(const ConfigStore& store, const BoardProfile& board, const ReceiverSettings& base) {
    ReceiverSettings settings = base;
    const auto at_least_1 = [&](std::uint32_t item) { return std::max<std::uint64_t>(1, store.value(item)); };
    const std::chrono::milliseconds measurement(at_least_1(key::rate_meas));
    const auto cycles = static_cast<std::int64_t>(at_least_1(key::rate_nav));
    set_navigation_period(settings, feasible_period(measurement, cycles, board), board);
    const auto most = static_cast<std::size_t>(at_least_1(key::navspg_max_svs));
    settings.most_satellites = settings.most_satellites > 0 ? std::min(settings.most_satellites, most) : most;
    if (signals_changed(store) || base.signals.empty()) settings.signals = chosen_signals(store, base.signals);
    settings.sbas_scan_mask = store.value(key::sbas_scan_mask);
    settings.sbas_ranging = store.flag(legacy_key::sbas_ranging);
    settings.sbas_corrections = store.flag(legacy_key::sbas_corrections);
    settings.sbas_test_mode = store.flag(legacy_key::sbas_test_mode);
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
    put(key::rate_meas, measurement_period_ms(board, options.rate_hz));
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

}  // namespace skyloop::firmware
