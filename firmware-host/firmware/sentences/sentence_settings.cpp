#include "firmware/sentences/sentence_settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "firmware/core/state_tracker.hpp"
#include "firmware/sentences/sentence_maker.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop::firmware {
namespace {

using Settings = SentenceSettings;

ConfigValues factory_values(const BoardProfile& board, const ReceiverOptions& options,
                            std::span<const OwnSetting> own) {
    const ReceiverConfig factory = factory_settings(board, options);
    ConfigValues values;
    values[Settings::fix_interval_ms] = measurement_period_ms(board, options.rate_hz);
    values[Settings::dynamic_model] = static_cast<std::uint64_t>(factory.limits.dynamic_model);
    values[Settings::held_below_cmps] =
        static_cast<std::uint64_t>(std::lround(factory.limits.held_below.value() * 100));
    values[Settings::sbas_corrections] = 1;
    for (std::size_t i = 0; i < constellation_names.size(); ++i) {
        const auto system = static_cast<Constellation>(i);
        values[Settings::system(system)] = factory.has_on(system);
    }
    for (const PortId port : board.ports) {
        if (is_uart(port)) values[Settings::baud(port)] = factory.port(port).baud;
        values[Settings::rtcm_in(port)] = 1;
        for (std::size_t sentence = 0; sentence < std::size(nmea_sentence_names); ++sentence)
            values[Settings::rate(sentence, port)] = factory_rate(board, sentence);
    }
    for (const OwnSetting& setting : own)
        values[setting.key] = setting.factory;
    return values;
}

std::map<std::uint32_t, std::string> names_of(const BoardProfile& board, std::span<const OwnSetting> own) {
    std::map<std::uint32_t, std::string> names{{Settings::fix_interval_ms, "fix_interval_ms"},
                                               {Settings::dynamic_model, "dynamic_model"},
                                               {Settings::held_below_cmps, "held_below_cmps"},
                                               {Settings::sbas_corrections, "sbas_corrections"}};
    for (const OwnSetting& setting : own)
        names[setting.key] = setting.name;
    for (std::size_t i = 0; i < constellation_names.size(); ++i)
        names[Settings::system(static_cast<Constellation>(i))] = constellation_names[i];
    for (const PortId port : board.ports) {
        const std::string_view of_port = port_names[static_cast<std::size_t>(port)];
        names[Settings::baud(port)] = fmt::format("baud_{}", of_port);
        names[Settings::rtcm_in(port)] = fmt::format("rtcm3_{}", of_port);
        for (std::size_t sentence = 0; sentence < std::size(nmea_sentence_names); ++sentence)
            names[Settings::rate(sentence, port)] = fmt::format("{}_{}", nmea_sentence_names[sentence], of_port);
    }
    return names;
}

}  // namespace

std::vector<PortId> uarts_of(const BoardProfile& board) {
    std::vector<PortId> uarts;
    std::ranges::copy_if(board.ports, std::back_inserter(uarts), is_uart);
    return uarts;
}

bool can_fix_each(const BoardProfile& board, std::uint64_t period_ms) {
    return static_cast<double>(period_ms) * board.max_rate_hz >= 999.5;
}

SentenceSettings::SentenceSettings(const BoardProfile& board, const ReceiverOptions& options,
                                   std::span<const OwnSetting> own)
    : LayeredValues(factory_values(board, options, own)),
      board_(board),
      factory_(factory_settings(board, options)),
      names_(names_of(board, own)) {}

std::optional<std::uint32_t> SentenceSettings::rate(std::string_view sentence, PortId port) {
    const auto* const found = std::ranges::find(nmea_sentence_names, sentence);
    if (found == std::end(nmea_sentence_names)) return std::nullopt;
    return rate(static_cast<std::size_t>(found - std::begin(nmea_sentence_names)), port);
}

bool SentenceSettings::can_have(const std::vector<std::pair<Constellation, bool>>& wanted) const {
    ConfigValues after = values(ConfigLayer::ram);
    for (const auto& [constellation, on] : wanted)
        after[system(constellation)] = on;
    int major = 0;
    for (std::size_t i = 0; i < constellation_names.size(); ++i) {
        const auto constellation = static_cast<Constellation>(i);
        if (gives_position(constellation) && after[system(constellation)] != 0) ++major;
    }
    return major > 0 && major <= board_.most_systems;
}

// A system that is switched on has the signals of the run, or where the run has none of it those of the board.
void SentenceSettings::put_systems(ReceiverConfig& config) const {
    std::vector<Constellation> on;
    for (const Constellation constellation : systems_in_order)
        if (flag(system(constellation))) on.push_back(constellation);
    if (on == config.systems) return;
    std::set<SystemSignal> signals;
    for (const Constellation constellation : on) {
        const auto of_it = [&](const SystemSignal& signal) { return signal.constellation == constellation; };
        const std::set<SystemSignal>& known = config.settings.signals;
        const std::set<SystemSignal> own =
            std::ranges::any_of(known, of_it) ? known : factory_signals(board_, constellation);
        std::ranges::copy_if(own, std::inserter(signals, signals.end()), of_it);
    }
    config.systems = on;
    config.settings.signals = signals;
}

ReceiverConfig SentenceSettings::config() const {
    ReceiverConfig config = factory_;
    const auto changed = [&](std::uint32_t key) { return stored(ConfigLayer::factory, key) != value(key); };
    set_navigation_period(config.settings,
                          feasible_period(std::chrono::milliseconds(value(fix_interval_ms)), 1, board_), board_);
    config.limits.dynamic_model = static_cast<int>(value(dynamic_model));
    if (changed(dynamic_model)) config.settings.dynamic_model = dynamic_model_of(value(dynamic_model));
    config.limits.held_below = MetresPerSecond(static_cast<double>(value(held_below_cmps)) / 100);
    if (changed(held_below_cmps)) config.settings.static_hold_below = config.limits.held_below;
    config.settings.sbas_corrections = flag(sbas_corrections);
    put_systems(config);
    for (const PortId port : board_.ports)
        if (is_uart(port))
            config.ports[static_cast<std::size_t>(port)].baud = static_cast<std::uint32_t>(value(baud(port)));
    return config;
}

void SentenceSettings::keep(std::uint32_t key, std::uint64_t value) {
    if (stored(ConfigLayer::factory, key) != value)
        set(in_flash, key, value);
    else
        erase(in_flash, key);
}

std::string SentenceSettings::name_of(std::uint32_t key) const { return names_.at(key); }

std::optional<std::uint32_t> SentenceSettings::key_of(std::string_view name) const {
    const auto found =
        std::ranges::find(names_, name, [](const auto& entry) { return std::string_view(entry.second); });
    return found == names_.end() ? std::nullopt : std::optional(found->first);
}

}  // namespace skyloop::firmware
