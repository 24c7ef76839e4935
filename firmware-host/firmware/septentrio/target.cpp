// What a Septentrio's settings make of the receiver.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "base/core/number_text.hpp"
#include "firmware/core/state_tracker.hpp"
#include "firmware/septentrio/console.hpp"
#include "firmware/septentrio/rover_and_station.hpp"

namespace skyloop::firmware {

using namespace std::chrono_literals;

namespace {

struct SystemName {
    Constellation constellation;
    std::string_view name;
    char letter;
};
constexpr std::array system_names{
    SystemName{Constellation::gps, "GPS", 'G'},         SystemName{Constellation::glonass, "GLONASS", 'R'},
    SystemName{Constellation::galileo, "GALILEO", 'E'}, SystemName{Constellation::sbas, "SBAS", 'S'},
    SystemName{Constellation::beidou, "BEIDOU", 'C'},   SystemName{Constellation::qzss, "QZSS", 'J'},
    SystemName{Constellation::navic, "NAVIC", 'I'},
};

bool names_system(const std::vector<std::string>& words, const SystemName& system) {
    return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
        const bool satellite = word.size() >= 3 && word[0] == system.letter && word[1] >= '0' && word[1] <= '9';
        return satellite || same_word(word, system.name) || same_word(word, "all");
    });
}

bool names_signal(std::string_view signals, Constellation system) {
    return std::ranges::any_of(septentrio_signals(), [&](const NamedSignal& known) {
        return known.signal.constellation == system && lists(signals, known.name);
    });
}

}  // namespace

// The board or a scenario may have it begin in another way than the factory's settings say.
void SeptentrioConsole::adopt() {
    SeptentrioSettings& settings = state_.settings;
    if (!board_.sbf_blocks.empty())
        settings.set(setting_group("SBFOutput"),
                     {"Stream1", "COM1", fmt::format("{}", fmt::join(board_.sbf_blocks, "+")), "OnChange"});
    for (const PortId port : board_.ports)
        if (is_uart(port))
            settings.set(setting_group("COMSettings"),
                         {std::string(descriptor_of(port)), fmt::format("baud{}", start_.config.port(port).baud)});
    settings.set(setting_group("ElevationMask"),
                 {"PVT", fmt::format("{}", std::lround(start_.config.elevation_mask.deg()))});
    std::vector<std::string_view> systems, signals;
    for (const SystemName& system : system_names)
        if (start_.systems.contains(system.constellation)) systems.push_back(system.name);
    for (const NamedSignal& known : septentrio_signals())
        if (start_.signals.contains(known.signal)) signals.push_back(known.name);
    if (systems.empty() || signals.empty()) return;
    const std::string tracked = fmt::format("{}", fmt::join(systems, "+")),
                      measured = fmt::format("{}", fmt::join(signals, "+"));
    settings.set(setting_group("SatelliteTracking"), {tracked});
    settings.set(setting_group("SatelliteUsage"), {tracked});
    settings.set(setting_group("SignalTracking"), {measured});
    settings.set(setting_group("SignalUsage"), {measured, measured});
}

// What measurement and solution must know.
void SeptentrioConsole::apply(SeptentrioTarget& to) const {
    const SeptentrioSettings& settings = state_.settings;
    const auto own = static_cast<std::uint64_t>(start_.config.settings.navigation_period / 1ms);
    const auto period =
        std::max(wanted_period_ms(settings, own).value_or(own), static_cast<std::uint64_t>(1000 / board_.max_rate_hz));
    set_navigation_period(to.config.settings, feasible_period(std::chrono::milliseconds(period), 1, board_), board_);
    const auto mask = [&](const char* engine) {
        return number_in<int>(settings.values("ElevationMask", engine).front()).value_or(-90);
    };
    const Angle elevation = Angle::degrees(std::max(mask("Tracking"), mask("PVT")));
    const bool as_at_start = elevation.deg() == start_.config.elevation_mask.deg();
    to.config.elevation_mask = elevation;
    to.config.settings.elevation_mask = as_at_start ? start_.config.settings.elevation_mask : elevation;
    to.config.settings.subframes = wants_messages(settings);
    const std::string& oldest = settings.values("DiffCorrUsage")[1];  // MaxAge
    if (const auto seconds = number_in<double>(oldest)) to.config.corrections.timeout = Seconds(*seconds);
    for (const PortId port : board_.ports)
        to.config.ports[static_cast<std::size_t>(port)].in.rtcm3 = lets_in(port, "RTCMv3");
    apply_systems(to);
    apply_signals(to);
    apply_station(to);
}

// Until it is told how it moves, the receiver goes by what the run says.
void SeptentrioConsole::apply_motion(SeptentrioTarget& to) const {
    const auto model = model_of_motion(state_.settings.values("ReceiverDynamics")[1]);
    if (!model) return;
    to.config.limits.dynamic_model = static_cast<int>(*model);
    const bool as_at_start = to.config.limits.dynamic_model == start_.config.limits.dynamic_model;
    to.config.settings.dynamic_model = as_at_start ? start_.config.settings.dynamic_model : dynamic_model_of(*model);
}

void SeptentrioConsole::apply_talker(SeptentrioTarget& to) const {
    constexpr std::array<std::string_view, 4> talkers{"auto", "GP", "GL", "GN"};
    const std::string& wanted = state_.settings.values("NMEATalkerID").front();
    const auto found = std::ranges::find_if(talkers, [&](auto word) { return same_word(word, wanted); });
    if (found == talkers.end()) return;
    to.config.nmea.talker = found == talkers.begin() ? board_.main_talker : std::string(*found);
}

// Of a system that is tracked one signal at least stays.
void SeptentrioConsole::apply_signals(SeptentrioTarget& to) const {
    const std::string& wanted = state_.settings.values("SignalTracking").front();
    for (const Constellation system : systems_in_order) {
        if (!names_signal(wanted, system)) continue;
        for (const NamedSignal& known : septentrio_signals()) {
            if (known.signal.constellation != system) continue;
            if (lists(wanted, known.name))
                to.signals.insert(known.signal);
            else
                to.signals.erase(known.signal);
        }
    }
    to.put_signals(start_);
}

void SeptentrioConsole::apply_speeds(SeptentrioTarget& to) const {
    for (const PortId port : board_.ports) {
        if (!is_uart(port)) continue;
        constexpr std::string_view prefix = "baud";
        const std::string& word = state_.settings.values("COMSettings", descriptor_of(port)).front();
        if (const auto baud = number_in<int>(std::string_view(word).substr(prefix.size())))
            to.config.ports[static_cast<std::size_t>(port)].baud = static_cast<std::uint32_t>(*baud);
    }
}

// A place that it was given makes it a base station. Positions are kept to 0.1 mm.
void SeptentrioConsole::apply_station(SeptentrioTarget& to) const {
    to.config.station = number_in<int>(state_.settings.values("RTCMv3Formatting").front()).value_or(0) & 0xFFF;
    const auto place = told_place(state_.settings);
    to.config.place.reset();
    if (!place) return;
    const auto kept = [&](Eigen::Index axis) {
        const auto tenths_of_mm = std::llround(place->vector()[axis] * 1e4);
        return (static_cast<double>(tenths_of_mm / 100) + static_cast<double>(tenths_of_mm % 100) * 1e-2) * 1e-2;
    };
    to.config.place = BasePlace{Position<Ecef>(kept(0), kept(1), kept(2)), Metres(0)};
}

// None that gives a position leaves no receiver to speak of: then nothing changes.
void SeptentrioConsole::apply_systems(SeptentrioTarget& to) const {
    const auto tracked = split_words(state_.settings.values("SatelliteTracking").front(), '+');
    const auto used = split_words(state_.settings.values("SatelliteUsage").front(), '+');
    const std::string& signals = state_.settings.values("SignalTracking").front();
    std::set<Constellation> wanted;
    for (const SystemName& system : system_names)
        if (names_system(tracked, system) && names_system(used, system) && names_signal(signals, system.constellation))
            wanted.insert(system.constellation);
    const auto major = std::ranges::count_if(wanted, gives_position);
    if (major > 0 && major <= board_.most_systems) to.systems = wanted;
    to.put_signals(start_);
}

void SeptentrioTarget::put_signals(const SeptentrioTarget& start) {
    config.systems.clear();
    std::set<SystemSignal> measured;
    for (const Constellation system : systems_in_order) {
        if (!systems.contains(system)) continue;
        const auto of_it = [&](const SystemSignal& signal) { return signal.constellation == system; };
        if (std::ranges::any_of(signals, of_it)) config.systems.push_back(system);
        std::ranges::copy_if(signals, std::inserter(measured, measured.end()), of_it);
    }
    const bool as_at_start = systems == start.systems && signals == start.signals;
    config.settings.signals = as_at_start ? start.config.settings.signals : measured;
}

SeptentrioTarget SeptentrioTarget::at_start(const BoardProfile& board, const ReceiverOptions& options) {
    SeptentrioTarget target;
    target.config = factory_settings(board, options);
    target.config.reports_dead_reckoning = false;
    target.config.reports_spoofing = target.config.reports_jamming_elsewhere = true;
    for (PortConfig& port : target.config.ports)
        port.in.rtcm3 = true;
    target.systems = {target.config.systems.begin(), target.config.systems.end()};
    const std::set<SystemSignal>& measured = target.config.settings.signals;
    for (const Constellation system : systems_in_order) {
        const auto of_it = [&](const SystemSignal& signal) { return signal.constellation == system; };
        const std::set<SystemSignal> own =
            std::ranges::any_of(measured, of_it) ? measured : factory_signals(board, system);
        std::ranges::copy_if(own, std::inserter(target.signals, target.signals.end()), of_it);
    }
    return target;
}

}  // namespace skyloop::firmware
