#include "firmware/septentrio/console.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/core/number_text.hpp"
#include "firmware/config/config_keys.hpp"
#include "firmware/config/legacy_keys.hpp"
#include "firmware/config/signal_keys.hpp"
#include "firmware/septentrio/rover_and_station.hpp"

namespace skyloop::firmware {

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

// The item that switches a system on; nothing for one that this receiver does not have.
std::optional<std::uint32_t> switch_of(const SystemName& system, const ConfigStore& store) {
    for (const SystemKeys& keys : system_keys_of_signals)
        if (keys.constellation == system.constellation && store.has(keys.enable)) return keys.enable;
    return std::nullopt;
}

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
    return std::any_of(signal_keys.begin(), signal_keys.end(), [&](const SignalKey& key) {
        const std::string_view name = signal_name(key.signal);
        return key.signal.constellation == system && !name.empty() && lists(signals, name);
    });
}

// Of the two items that stand for BeiDou's measured signal on L1 this receiver uses the other.
constexpr std::uint32_t b1c_for_b1i = 0x1031000F;

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

SeptentrioConsole::SeptentrioConsole(const BoardProfile& board, const ConfigStore& store)
    : board_(board), own_period_ms_(store.value(key::rate_meas)) {
    adopt(store);
    factory_ = at_start_ = state_.settings;
}

// The board or a scenario may have it begin in another way than the factory's settings say.
void SeptentrioConsole::adopt(const ConfigStore& store) {
    SeptentrioSettings& settings = state_.settings;
    if (!board_.sbf_blocks.empty())
        settings.set(group_of("SBFOutput"),
                     {"Stream1", "COM1", fmt::format("{}", fmt::join(board_.sbf_blocks, "+")), "OnChange"});
    const auto speed = [&](const char* port, std::uint32_t item) {
        settings.set(group_of("COMSettings"), {port, fmt::format("baud{}", store.value(item))});
    };
    speed("COM1", key::uart1_baudrate);
    speed("COM2", key::uart2_baudrate);
    settings.set(group_of("ElevationMask"), {"PVT", fmt::format("{}", store.signed_value(key::navspg_min_elev))});
    std::string systems, signals;
    for (const SystemName& system : system_names)
        if (const auto item = switch_of(system, store); item && store.flag(*item))
            systems += fmt::format("{}{}", systems.empty() ? "" : "+", system.name);
    for (const SignalKey& signal : signal_keys) {
        const std::string_view name = signal_name(signal.signal);
        if (name.empty() || signal.enable == b1c_for_b1i || !store.has(signal.enable) || !store.flag(signal.enable))
            continue;
        signals += fmt::format("{}{}", signals.empty() ? "" : "+", name);
    }
    if (systems.empty() || signals.empty()) return;
    settings.set(group_of("SatelliteTracking"), {systems});
    settings.set(group_of("SatelliteUsage"), {systems});
    settings.set(group_of("SignalTracking"), {signals});
    settings.set(group_of("SignalUsage"), {signals, signals});
}

bool SeptentrioConsole::lets_in(PortId port, std::string_view input) const {
    const std::string_view descriptor = descriptor_of(port);
    if (descriptor.empty()) return true;
    const auto& directions = state_.settings.values("DataInOut", descriptor);
    return directions.empty() || same_word(directions[0], "auto") || same_word(directions[0], input);
}

bool SeptentrioConsole::hears_corrections(PortId port) const { return lets_in(port, "RTCMv3"); }

CommandOutcome SeptentrioConsole::execute(const std::string& line, ConfigStore& store, PortId from) {
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
    const std::string text = answer(command, store, outcome);
    outcome.answers.push_back(to_bytes(text + (outcome.restart ? "STOP>" : prompt)));
    return outcome;
}

std::string SeptentrioConsole::answer(const Command& command, ConfigStore& store, CommandOutcome& outcome) {
    for (const SettingGroup& group : setting_groups()) {
        if (command.is(group.get, fmt::format("get{}", group.name)))
            return setting_told(command.line, state_.settings.get(group, command.arguments));
        if (!command.is(group.set, fmt::format("set{}", group.name))) continue;
        const SettingAnswer answer = state_.settings.set(group, command.arguments);
        if (!answer.error.empty()) return setting_told(command.line, answer);
        apply(store);
        if (group.name == "COMSettings") apply_speeds(store);
        if (group.name == "ReceiverDynamics") apply_motion(store);
        if (group.name == "NMEATalkerID") apply_talker(store);
        if (group.name == "SBFOutput") state_.told_records.clear();
        if (group.name == "SBFOutput") state_.told_setup.reset();
        return setting_told(command.line, answer);
    }
    return act(command, store, outcome);
}

// What is no setting.
std::string SeptentrioConsole::act(const Command& command, const ConfigStore& store, CommandOutcome& outcome) {
    const auto done = [&](const std::string& state) { return told(':', command.line, {state}); };
    const auto arguments = fmt::format("{}", fmt::join(command.arguments, ", "));
    if (command.is("gecm", "getEchoMessage") || command.is("eecm", "exeEchoMessage"))
        return done("EchoMessage, " +
                    (arguments.empty() ? fmt::format("{}, , none", descriptor_of(command.from)) : arguments));
    if (command.is("grc", "getReceiverCapabilities")) return done(capabilities(store));
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
        outcome.restart = start_after(second);
        return done("ResetReceiver");
    }
    return refused("ASCII commands: Invalid command!");
}

// Antennas, signals, ports, abilities, and the shortest periods of measurements and solutions, ms.
std::string SeptentrioConsole::capabilities(const ConfigStore& store) const {
    std::vector<std::string_view> signals, ports;
    for (const SignalKey& key : signal_keys)
        if (const auto name = signal_name(key.signal);
            !name.empty() && key.enable != b1c_for_b1i && store.has(key.enable))
            signals.push_back(name);
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

void SeptentrioConsole::restart(ConfigStore& store) {
    state_ = {at_start_, true, state_.commands};
    apply(store);
    if (speeds_saved_) apply_speeds(store);
    const auto is_changed = [&](const char* name) {
        return at_start_.values(name) != SeptentrioSettings().values(name);
    };
    if (is_changed("ReceiverDynamics")) apply_motion(store);
    if (is_changed("NMEATalkerID")) apply_talker(store);
}

// What measurement and solution must know.
void SeptentrioConsole::apply(ConfigStore& store) const {
    const SeptentrioSettings& settings = state_.settings;
    const auto period = std::max(wanted_period_ms(settings, own_period_ms_).value_or(own_period_ms_),
                                 static_cast<std::uint64_t>(1000 / board_.max_rate_hz));
    store.set(in_ram, key::rate_meas, period);
    const auto mask = [&](const char* engine) {
        return number_in<int>(settings.values("ElevationMask", engine).front()).value_or(-90);
    };
    store.set(in_ram, key::navspg_min_elev, static_cast<std::uint8_t>(std::max(mask("Tracking"), mask("PVT"))));
    apply_systems(store);
    apply_signals(store);
    apply_station(store);
}

// Until it is told how it moves, the receiver goes by what the run says.
void SeptentrioConsole::apply_motion(ConfigStore& store) const {
    if (const auto model = model_of_motion(state_.settings.values("ReceiverDynamics")[1]))
        store.set(in_ram, key::navspg_dynmodel, *model);
}

// CFG-NMEA-MAINTALKERID.
void SeptentrioConsole::apply_talker(ConfigStore& store) const {
    constexpr std::array<std::string_view, 4> talkers{"auto", "GP", "GL", "GN"};
    const std::string& wanted = state_.settings.values("NMEATalkerID").front();
    const auto found = std::find_if(talkers.begin(), talkers.end(), [&](auto word) { return same_word(word, wanted); });
    if (found != talkers.end())
        store.set(in_ram, key::nmea_main_talker, static_cast<std::uint64_t>(found - talkers.begin()));
}

// Of a system that is tracked one signal at least stays.
void SeptentrioConsole::apply_signals(ConfigStore& store) const {
    const std::string& wanted = state_.settings.values("SignalTracking").front();
    for (const SystemKeys& system : system_keys_of_signals) {
        std::vector<std::pair<std::uint32_t, bool>> items;
        for (const SignalKey& signal : signal_keys)
            if (const auto name = signal_name(signal.signal);
                signal.signal.constellation == system.constellation && !name.empty() && store.has(signal.enable))
                items.emplace_back(signal.enable, lists(wanted, name) && signal.enable != b1c_for_b1i);
        if (std::none_of(items.begin(), items.end(), [](const auto& item) { return item.second; })) continue;
        for (const auto& [item, on] : items)
            store.set(in_ram, item, on ? 1 : 0);
    }
}

void SeptentrioConsole::apply_speeds(ConfigStore& store) const {
    const auto apply_speed = [&](std::string_view port, std::uint32_t item) {
        constexpr std::string_view prefix = "baud";
        const std::string& word = state_.settings.values("COMSettings", port).front();
        if (const auto baud = number_in<int>(std::string_view(word).substr(prefix.size())))
            store.set(in_ram, item, static_cast<std::uint32_t>(*baud));
    };
    apply_speed("COM1", key::uart1_baudrate);
    apply_speed("COM2", key::uart2_baudrate);
}

// A place that it was told makes it a base in fixed mode, as CFG-TMODE does others.
void SeptentrioConsole::apply_station(ConfigStore& store) const {
    constexpr std::uint32_t station_item = 0x30090001;  // CFG-RTCM-DF003_OUT
    constexpr std::uint64_t moving = 0, fixed = 2;
    const int station = number_in<int>(state_.settings.values("RTCMv3Formatting").front()).value_or(0);
    store.set(in_ram, station_item, static_cast<std::uint64_t>(station));
    const auto place = told_place(state_.settings);
    store.set(in_ram, key::tmode_mode, place ? fixed : moving);
    if (!place) return;
    store.set(in_ram, legacy_key::tmode_pos_type, 0);
    for (std::uint32_t i = 0; i < 3; ++i) {
        const auto tenths_of_mm = std::llround(place->vector()[static_cast<Eigen::Index>(i)] * 1e4);
        store.set(in_ram, legacy_key::tmode_ecef + i, static_cast<std::uint64_t>(tenths_of_mm / 100));
        store.set(in_ram, legacy_key::tmode_ecef_hp + i, static_cast<std::uint64_t>(tenths_of_mm % 100));
    }
}

void SeptentrioConsole::apply_systems(ConfigStore& store) const {
    const auto tracked = split_words(state_.settings.values("SatelliteTracking").front(), '+');
    const auto used = split_words(state_.settings.values("SatelliteUsage").front(), '+');
    const std::string& signals = state_.settings.values("SignalTracking").front();
    std::vector<std::pair<Constellation, bool>> wanted;
    bool changed = false;
    for (const SystemName& system : system_names) {
        const auto item = switch_of(system, store);
        if (!item) continue;
        wanted.emplace_back(system.constellation, names_system(tracked, system) && names_system(used, system) &&
                                                      names_signal(signals, system.constellation));
        changed = changed || store.flag(*item) != wanted.back().second;
    }
    // None that gives a position leaves no receiver to speak of: then nothing changes.
    if (changed) set_systems(board_, store, in_ram, wanted);
}

}  // namespace skyloop::firmware
