#include "firmware/septentrio/console.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

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
    if (forced) state_.settings.set(setting_group("DataInOut"), {std::string(descriptor), "auto"});
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

std::string SeptentrioConsole::boot_text() const {
    std::string text;
    for (const SettingGroup& group : setting_groups()) {
        const std::vector<std::string> saved = at_start_.get(group, {}).states,
                                       factory = factory_.get(group, {}).states;
        for (std::size_t i = 0; i < saved.size(); ++i)
            if (saved[i] != factory.at(i)) text += saved[i] + "\n";
    }
    return text;
}

Result<void> SeptentrioConsole::load(const std::string& text, const std::string& name, SeptentrioTarget& to) {
    SeptentrioSettings saved = factory_;
    int number = 0;
    for (const std::string& line : split_words(text, '\n')) {
        ++number;
        if (line.empty()) continue;
        const std::vector<std::string> words = split_words(line, ',');
        const auto group = std::ranges::find(setting_groups(), words[0], &SettingGroup::name);
        if (group == setting_groups().end())
            return fail(ErrorCode::input,
                        fmt::format("{}:{}: '{}' is no setting of {}", name, number, words[0], board_.name));
        const SettingAnswer answer = saved.set(*group, {words.begin() + 1, words.end()});
        if (!answer.error.empty()) return fail(ErrorCode::input, fmt::format("{}:{}: {}", name, number, answer.error));
    }
    at_start_ = saved;
    speeds_saved_ = true;
    restart(to);
    return {};
}

}  // namespace skyloop::firmware
