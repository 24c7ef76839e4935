#include "firmware/core/factory_settings.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/core/port.hpp"
#include "firmware/core/state_tracker.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop::firmware {
namespace {

std::vector<Constellation> systems_of(const BoardProfile& board, const ReceiverSettings& wanted) {
    std::vector<Constellation> systems;
    for (const Constellation system : systems_in_order) {
        const bool of_board = std::ranges::find(board.constellations, system) != board.constellations.end();
        const bool asked = std::ranges::any_of(
            wanted.signals, [&](const SystemSignal& signal) { return signal.constellation == system; });
        if (wanted.signals.empty() ? of_board : asked) systems.push_back(system);
    }
    return systems;
}

}  // namespace

bool gives_position(Constellation system) {
    using enum Constellation;
    return system == gps || system == glonass || system == galileo || system == beidou;
}

std::set<SystemSignal> factory_signals(const BoardProfile& board, Constellation system) {
    std::set<SystemSignal> signals{{system, first_signal(system)}};
    if (const auto second = second_signal(system, board.second_band); second && board.dual_frequency)
        signals.insert({system, *second});
    return signals;
}

Nanoseconds feasible_period(Nanoseconds measurement, std::int64_t measurements, const BoardProfile& board) {
    // Periods are whole milliseconds. 18 Hz are stored as 56, and asked for as 55 by who leaves the rest of a division
    // out: that must not be half of the rate.
    const auto shortest = std::chrono::milliseconds(static_cast<std::int64_t>(std::floor(1000.0 / board.max_rate_hz)));
    while (measurements * measurement < shortest)
        ++measurements;
    return measurements * measurement;
}

std::uint64_t measurement_period_ms(const BoardProfile& board, double rate_hz) {
    constexpr double longest_ms = 65535;
    const double rate = std::min(rate_hz > 0 ? rate_hz : board.default_rate_hz, board.max_rate_hz);
    return static_cast<std::uint64_t>(std::llround(std::clamp(1000.0 / rate, 1.0, longest_ms)));
}

void set_navigation_period(ReceiverSettings& settings, Nanoseconds period, const BoardProfile& board) {
    settings.navigation_period = period;
    const double rate = 1e9 / static_cast<double>(period.count());
    const bool is_fast = board.all_satellites_rate_hz > 0 && rate > board.all_satellites_rate_hz;
    settings.most_satellites = is_fast ? static_cast<std::size_t>(board.fast_satellites) : 0;
}

ReceiverConfig factory_settings(const BoardProfile& board, const ReceiverOptions& options) {
    const ReceiverSettings& wanted = options.settings;
    ReceiverConfig config;
    config.settings = wanted;
    config.systems = systems_of(board, wanted);
    if (wanted.signals.empty())
        for (const Constellation system : config.systems)
            config.settings.signals.merge(factory_signals(board, system));
    const std::chrono::milliseconds measurement(measurement_period_ms(board, options.rate_hz));
    set_navigation_period(config.settings, feasible_period(measurement, 1, board), board);
    config.settings.dynamic_limits = board.dynamic_limits;
    config.settings.airborne_ceiling = airborne_ceiling(board.identity.generation);
    config.settings.course_held_below = board.course_min_speed;
    config.settings.subframes = false;
    config.elevation_mask = Angle::degrees(std::round(wanted.elevation_mask.deg()));
    config.limits.dynamic_model = static_cast<int>(dynamic_model_number(wanted.dynamic_model));
    const double hold_cm = std::clamp(std::round(wanted.static_hold_below.value() * 100), 0.0, 255.0);
    config.limits.held_below = MetresPerSecond(hold_cm / 100);
    config.watches_interference = board.quirks.default_interference_monitor;
    config.watches_antenna = board.quirks.voltage_control;
    config.nmea.version = board.nmea_version;
    config.nmea.numbering = board.satellite_numbering;
    config.nmea.talker = board.main_talker;
    config.nmea.beidou_talker = board.style.beidou_talker;
    for (std::size_t port = 0; port < port_count; ++port)
        config.ports[port].baud = factory_baud(static_cast<PortId>(port), board);
    return config;
}

}  // namespace skyloop::firmware
