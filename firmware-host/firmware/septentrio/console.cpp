#include "firmware/septentrio/console.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "firmware/config/config_keys.hpp"
#include "firmware/config/signal_keys.hpp"

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
    std::string_view name, first_signal;
    char letter;
};
constexpr std::array system_names{
    SystemName{Constellation::gps, "GPS", "GPSL1CA", 'G'},
    SystemName{Constellation::glonass, "GLONASS", "GLOL1CA", 'R'},
    SystemName{Constellation::galileo, "GALILEO", "GALL1BC", 'E'},
    SystemName{Constellation::sbas, "SBAS", "GEOL1", 'S'},
    SystemName{Constellation::beidou, "BEIDOU", "BDSB1I", 'C'},
    SystemName{Constellation::qzss, "QZSS", "QZSL1CA", 'J'},
    SystemName{Constellation::navic, "NAVIC", "NAVICL5", 'I'},
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
        const bool satellite = word.size() == 3 && word[0] == system.letter && word[1] >= '0' && word[1] <= '9';
        return satellite || same_word(word, system.name) || same_word(word, "all");
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

SeptentrioConsole::SeptentrioConsole(const BoardProfile& board, const ConfigStore& store)
    : board_(board), own_period_ms_(store.value(key::rate_meas)) {
    adopt(store);
    at_start_ = state_.settings;
}

// The board or a scenario may have it begin in another way than the factory's settings say.
void SeptentrioConsole::adopt(const ConfigStore& store) {
    SeptentrioSettings& settings = state_.settings;
    const auto speed = [&](const char* port, std::uint32_t item) {
        settings.set(group_of("COMSettings"), {port, fmt::format("baud{}", store.value(item))});
    };
    speed("COM1", key::uart1_baudrate);
    speed("COM2", key::uart2_baudrate);
    settings.set(group_of("ElevationMask"), {"all", fmt::format("{}", store.signed_value(key::navspg_min_elev))});
    std::string systems, signals;
    for (const SystemName& system : system_names)
        if (const auto item = switch_of(system, store); item && store.flag(*item)) {
            systems += fmt::format("{}{}", systems.empty() ? "" : "+", system.name);
            signals += fmt::format("{}{}", signals.empty() ? "" : "+", system.first_signal);
        }
    if (systems.empty()) return;
    settings.set(group_of("SatelliteTracking"), {systems});
    settings.set(group_of("SatelliteUsage"), {systems});
    settings.set(group_of("SignalTracking"), {signals});
    settings.set(group_of("SignalUsage"), {signals, signals});
}

bool SeptentrioConsole::hears_commands(PortId port) const {
    const auto& directions = state_.settings.values("DataInOut", descriptor_of(port));
    return directions.empty() || same_word(directions[0], "auto") || same_word(directions[0], "CMD");
}

CommandOutcome SeptentrioConsole::execute(const std::string& line, ConfigStore& store, PortId from) {
    CommandOutcome outcome;
    const std::string_view descriptor = descriptor_of(from);
    if (descriptor.empty()) return outcome;
    const std::string prompt = fmt::format("{}>", descriptor);
    std::vector<std::string> words = split_words(line, ',');
    constexpr std::size_t attention = 10;
    const bool forced = words[0].size() >= attention && words[0].find_first_not_of('S') == std::string::npos;
    if (forced) state_.settings.set(group_of("DataInOut"), {std::string(descriptor), "auto"});
    if (!hears_commands(from)) return outcome;
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
        if (answer.error.empty()) apply(store);
        if (answer.error.empty() && group.name == "COMSettings") apply_speeds(store);
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
    const std::string first = command.argument(0), second = command.argument(1);
    if (command.is("eccf", "exeCopyConfigFile")) {
        if (!same_word(second, "Boot")) return done("CopyConfigFile");
        speeds_saved_ = same_word(first, "Current");
        at_start_ = speeds_saved_ ? state_.settings : SeptentrioSettings();
        return done("CopyConfigFile");
    }
    if (command.is("emd", "exeManageDisk")) {
        if (same_word(second, "Mount")) state_.disk_mounted = true;
        if (same_word(second, "Unmount")) state_.disk_mounted = false;
        return done("ManageDisk");
    }
    if (command.is("erst", "exeResetReceiver")) {
        outcome.restart = start_after(second);
        return done("ResetReceiver");
    }
    return refused("ASCII commands: Invalid command!");
}

// Antennas, signals, ports, abilities, and the shortest periods of measurements and solutions, ms.
std::string SeptentrioConsole::capabilities(const ConfigStore& store) const {
    std::vector<std::string_view> signals, ports;
    for (const SystemName& system : system_names)
        if (switch_of(system, store)) signals.push_back(system.first_signal);
    for (const PortId port : board_.ports)
        if (const auto name = descriptor_of(port); !name.empty()) ports.push_back(name);
    const auto shortest = static_cast<int>(1000 / board_.max_rate_hz);
    return fmt::format("ReceiverCapabilities, Main, {}, {}, SBAS+DGNSSRover+RTKRover+RTCMv3x+APME+RAIM, {}, {}, {}",
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
    state_.settings = at_start_;
    state_.disk_mounted = true;
    apply(store);
    if (speeds_saved_) apply_speeds(store);
}

// What measurement and solution must know.
void SeptentrioConsole::apply(ConfigStore& store) const {
    const SeptentrioSettings& settings = state_.settings;
    const auto period = std::max(wanted_period_ms(settings, own_period_ms_).value_or(own_period_ms_),
                                 static_cast<std::uint64_t>(1000 / board_.max_rate_hz));
    store.set(in_ram, key::rate_meas, period);
    if (const auto degrees = whole_number(settings.values("ElevationMask", "PVT").front()))
        store.set(in_ram, key::navspg_min_elev, static_cast<std::uint8_t>(*degrees));
    apply_systems(store);
}

void SeptentrioConsole::apply_speeds(ConfigStore& store) const {
    const auto apply_speed = [&](std::string_view port, std::uint32_t item) {
        constexpr std::string_view prefix = "baud";
        const std::string& word = state_.settings.values("COMSettings", port).front();
        if (const auto baud = whole_number(std::string_view(word).substr(prefix.size())))
            store.set(in_ram, item, static_cast<std::uint32_t>(*baud));
    };
    apply_speed("COM1", key::uart1_baudrate);
    apply_speed("COM2", key::uart2_baudrate);
}

void SeptentrioConsole::apply_systems(ConfigStore& store) const {
    const auto tracked = split_words(state_.settings.values("SatelliteTracking").front(), '+');
    const auto used = split_words(state_.settings.values("SatelliteUsage").front(), '+');
    std::vector<std::pair<Constellation, bool>> wanted;
    bool changed = false;
    for (const SystemName& system : system_names) {
        const auto item = switch_of(system, store);
        if (!item) continue;
        wanted.emplace_back(system.constellation, names_system(tracked, system) && names_system(used, system));
        changed = changed || store.flag(*item) != wanted.back().second;
    }
    // None that gives a position leaves no receiver to speak of: then nothing changes.
    if (changed) set_systems(board_, store, in_ram, wanted);
}

}  // namespace skyloop::firmware
