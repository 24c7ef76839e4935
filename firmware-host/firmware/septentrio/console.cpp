#include "firmware/septentrio/console.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "base/core/number_text.hpp"
#include "firmware/core/state_tracker.hpp"
#include "firmware/septentrio/rover_and_station.hpp"

namespace skyloop::firmware {

using namespace std::chrono_literals;

struct SeptentrioConsole::Command {
    std::string line;  ///< as it was written
    std::string name;
    std::vector<std::string> arguments;
    PortId from = PortId::uart1;

    [[nodiscard]] bool is(std::string_view mnemonic, std::string_view whole) const {
        return same_word(name, mnemonic) || same_word(name, whole);
    }
    [[nodiscard]] std::string argument(std::size_t index) const {
        return index < arguments.size() ? arguments[index] : std::string();
    }
};

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

const SettingGroup& group_of(std::string_view name) {
    return *std::find_if(setting_groups().begin(), setting_groups().end(),
                         [&](const SettingGroup& group) { return group.name == name; });
}

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

// The guide's "exact copy of the command" in the form of each kind of answer.
std::string told(char kind, const std::string& line, const std::vector<std::string>& states) {
    std::string text = fmt::format("$R{} {}\r\n", kind, line);
    for (const std::string& state : states)
        text += "  " + state + "\r\n";
    return text;
}

std::string refused(const std::string& why) { return "$R? " + why + "\r\n"; }

std::string setting_told(const std::string& line, const SettingAnswer& answer) {
    return answer.error.empty() ? told(':', line, answer.states) : refused(answer.error);
}

StartKind start_after(const std::string& erased) {
    const std::vector<std::string> words = split_words(erased, '+');
    const auto has = [&](std::string_view word) {
        return std::any_of(words.begin(), words.end(), [&](const auto& w) { return same_word(w, word); });
    };
    if (has("SatData") || has("all")) return StartKind::cold;
    return has("PVTData") ? StartKind::warm : StartKind::hot;
}

}  // namespace

SeptentrioConsole::SeptentrioConsole(const BoardProfile& board, const SeptentrioTarget& start)
    : board_(board), start_(start) {
    adopt();
    factory_ = at_start_ = state_.settings;
}

// The board or a scenario may have it begin in another way than the factory's settings say.
void SeptentrioConsole::adopt() {
    SeptentrioSettings& settings = state_.settings;
    if (!board_.sbf_blocks.empty())
        settings.set(group_of("SBFOutput"),
                     {"Stream1", "COM1", fmt::format("{}", fmt::join(board_.sbf_blocks, "+")), "OnChange"});
    for (const PortId port : board_.ports)
        if (is_uart(port))
            settings.set(group_of("COMSettings"),
                         {std::string(descriptor_of(port)), fmt::format("baud{}", start_.config.port(port).baud)});
    settings.set(group_of("ElevationMask"),
                 {"PVT", fmt::format("{}", std::lround(start_.config.elevation_mask.deg()))});
    std::vector<std::string_view> systems, signals;
    for (const SystemName& system : system_names)
        if (start_.systems.contains(system.constellation)) systems.push_back(system.name);
    for (const NamedSignal& known : septentrio_signals())
        if (start_.signals.contains(known.signal)) signals.push_back(known.name);
    if (systems.empty() || signals.empty()) return;
    const std::string system_words = fmt::format("{}", fmt::join(systems, "+")),
                      signal_words = fmt::format("{}", fmt::join(signals, "+"));
    settings.set(group_of("SatelliteTracking"), {system_words});
    settings.set(group_of("SatelliteUsage"), {system_words});
    settings.set(group_of("SignalTracking"), {signal_words});
    settings.set(group_of("SignalUsage"), {signal_words, signal_words});
}

bool SeptentrioConsole::lets_in(PortId port, std::string_view input) const {
    const std::string_view descriptor = descriptor_of(port);
    if (descriptor.empty()) return true;
    const auto& directions = state_.settings.values("DataInOut", descriptor);
    return directions.empty() || same_word(directions[0], "auto") || same_word(directions[0], input);
}

CommandOutcome SeptentrioConsole::execute(const std::string& line, SeptentrioTarget& to, PortId from) {
    CommandOutcome outcome;
    const std::string_view descriptor = descriptor_of(from);
    if (descriptor.empty()) return outcome;
    const std::string prompt = fmt::format("{}>", descriptor);
    std::vector<std::string> words = split_words(line, ',');
    constexpr std::size_t attention = 10;
    const bool forced = words[0].size() >= attention && words[0].find_first_not_of('S') == std::string::npos;
    if (forced) state_.settings.set(group_of("DataInOut"), {std::string(descriptor), "auto"});
    if (!lets_in(from, "CMD")) return outcome;
    if (forced || words[0].empty() || words[0].front() == '#') {
        outcome.answers.push_back(to_bytes(prompt));
        return outcome;
    }
    Command command{line, words.front(), {words.begin() + 1, words.end()}, from};
    state_.commands = state_.commands == 255 ? std::uint8_t{1} : static_cast<std::uint8_t>(state_.commands + 1);
    const std::string text = answer(command, to, outcome);
    outcome.answers.push_back(to_bytes(text + (outcome.reset ? "STOP>" : prompt)));
    return outcome;
}

std::string SeptentrioConsole::answer(const Command& command, SeptentrioTarget& to, CommandOutcome& outcome) {
    for (const SettingGroup& group : setting_groups()) {
        if (command.is(group.get, fmt::format("get{}", group.name)))
            return setting_told(command.line, state_.settings.get(group, command.arguments));
        if (!command.is(group.set, fmt::format("set{}", group.name))) continue;
        const SettingAnswer answer = state_.settings.set(group, command.arguments);
        if (!answer.error.empty()) return setting_told(command.line, answer);
        apply(to);
        if (group.name == "COMSettings") apply_speeds(to);
        if (group.name == "ReceiverDynamics") apply_motion(to);
        if (group.name == "NMEATalkerID") apply_talker(to);
        if (group.name == "SBFOutput") state_.told_records.clear();
        if (group.name == "SBFOutput") state_.told_setup.reset();
        return setting_told(command.line, answer);
    }
    return act(command, outcome);
}

// What is no setting.
std::string SeptentrioConsole::act(const Command& command, CommandOutcome& outcome) {
    const auto done = [&](const std::string& state) { return told(':', command.line, {state}); };
    const auto arguments = fmt::format("{}", fmt::join(command.arguments, ", "));
    if (command.is("gecm", "getEchoMessage") || command.is("eecm", "exeEchoMessage"))
        return done("EchoMessage, " +
                    (arguments.empty() ? fmt::format("{}, , none", descriptor_of(command.from)) : arguments));
    if (command.is("grc", "getReceiverCapabilities")) return done(capabilities());
    if (command.is("gri", "getReceiverInterface"))
        return done(fmt::format("ReceiverInterface, RxName, {}", board_.identity.hardware));
    if (command.is("lif", "lstInternalFile")) {
        if (!same_word(command.argument(0), "Identification"))
            return refused("lstInternalFile: Argument 'File' is invalid!");
        return told(';', command.line, {}) + "---->\r\n$-- BLOCK 1 / 1\r\n" + identification();
    }
    if (command.is("login", "LogIn"))
        return told('!', "LogIn", {fmt::format("User {} logged in.", command.argument(0))});
    if (command.is("logout", "LogOut")) return told('!', "LogOut", {"User logged out."});
    return act_on_receiver(command, outcome);
}

std::string SeptentrioConsole::act_on_receiver(const Command& command, CommandOutcome& outcome) {
    const auto done = [&](std::string_view name) {
        return told(':', command.line, {fmt::format("{}, {}", name, fmt::join(command.arguments, ", "))});
    };
    const auto wrong = [&](std::string_view name, std::initializer_list<std::string_view> arguments) {
        return wrong_argument(name, arguments, command.arguments);
    };
    const std::string first = command.argument(0), second = command.argument(1);
    if (command.is("eccf", "exeCopyConfigFile")) {
        if (const auto why = wrong("CopyConfigFile", {"Source", "Target"}); !why.empty()) return refused(why);
        if (!same_word(second, "Boot")) return done("CopyConfigFile");
        speeds_saved_ = same_word(first, "Current");
        at_start_ = speeds_saved_ ? state_.settings : factory_;
        return done("CopyConfigFile");
    }
    if (command.is("emd", "exeManageDisk")) {
        if (const auto why = wrong("ManageDisk", {"Disk", "Action"}); !why.empty()) return refused(why);
        if (same_word(second, "Mount")) state_.disk_mounted = true;
        if (same_word(second, "Unmount")) state_.disk_mounted = false;
        return done("ManageDisk");
    }
    if (command.is("erst", "exeResetReceiver")) {
        if (const auto why = wrong("ResetReceiver", {"Level", "EraseMemory"}); !why.empty()) return refused(why);
        outcome.reset = Reset{Reset::Kind::software, Forgotten::of(start_after(second))};
        return done("ResetReceiver");
    }
    return refused("ASCII commands: Invalid command!");
}

// Antennas, signals, ports, abilities, and the shortest periods of measurements and solutions, ms.
std::string SeptentrioConsole::capabilities() const {
    std::vector<std::string_view> signals, ports;
    for (const NamedSignal& known : septentrio_signals())
        signals.push_back(known.name);
    for (const PortId port : board_.ports)
        if (const auto name = descriptor_of(port); !name.empty()) ports.push_back(name);
    const auto shortest = static_cast<int>(1000 / board_.max_rate_hz);
    return fmt::format(
        "ReceiverCapabilities, Main, {}, {}, SBAS+DGNSSRover+DGNSSBase+RTKRover+RTKBase+RTCMv3x+APME+RAIM, {}, {}, {}",
        fmt::join(signals, "+"), fmt::join(ports, "+"), shortest, shortest, shortest);
}

std::string SeptentrioConsole::identification() const {
    return fmt::format(
        "<?xml version=\"1.0\" encoding=\"UTF-8\" ?>\r\n<Identification>\r\n"
        "  <hardware-settings product=\"{}\" serial-number=\"{}\" />\r\n"
        "  <firmware version=\"{}\" product=\"{}\" />\r\n</Identification>\r\n",
        board_.identity.hardware, board_.usb ? board_.usb->serial : "", board_.identity.software,
        board_.identity.hardware);
}

void SeptentrioConsole::restart(SeptentrioTarget& to) {
    state_ = {at_start_, true, state_.commands};
    to = start_;
    apply(to);
    if (speeds_saved_) apply_speeds(to);
    const auto is_changed = [&](const char* name) {
        return at_start_.values(name) != SeptentrioSettings().values(name);
    };
    if (is_changed("ReceiverDynamics")) apply_motion(to);
    if (is_changed("NMEATalkerID")) apply_talker(to);
}

void SeptentrioConsole::forget(SeptentrioTarget& to) {
    state_.settings = at_start_ = factory_;
    speeds_saved_ = false;
    to = start_;
    apply(to);
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
