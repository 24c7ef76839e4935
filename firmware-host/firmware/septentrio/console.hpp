/// The command line of a Septentrio receiver (mosaic-X5 reference guide, firmware 4.14, chapter 3).
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/nmea_commands.hpp"
#include "firmware/septentrio/output.hpp"

namespace skyloop::firmware {

/// Executes lines: settings (`setXxx`, `getXxx`), actions (`exeXxx`), lists (`lstXxx`), by name or mnemonic.
/// State: the settings in force, those of the next start, the disk.
class SeptentrioConsole {
public:
    /// @param store by which the receiver is configured: speeds, rate, mask and systems follow the settings
    SeptentrioConsole(const BoardProfile& board, const ConfigStore& store);

    /// Answers end with the prompt; a wrong command is answered, a line of ten S takes the port back for commands.
    CommandOutcome execute(const std::string& line, ConfigStore& store, PortId from);
    /// Whether the input of a port lets RTCM 3 in (DataInOut).
    [[nodiscard]] bool hears_corrections(PortId port) const;
    /// After a restart the saved settings hold.
    void restart(ConfigStore& store);
    /// Takes an epoch in before what is due is made from it.
    void follow(const NavigationState& state) { follow_epoch(state_, board_, state); }
    [[nodiscard]] const SeptentrioState& state() const { return state_; }

private:
    struct Command;
    std::string answer(const Command& command, ConfigStore& store, CommandOutcome& outcome);
    std::string act(const Command& command, const ConfigStore& store, CommandOutcome& outcome);
    std::string act_on_receiver(const Command& command, CommandOutcome& outcome);
    [[nodiscard]] std::string capabilities(const ConfigStore& store) const;
    [[nodiscard]] std::string identification() const;
    [[nodiscard]] bool lets_in(PortId port, std::string_view input) const;
    void adopt(const ConfigStore& store);
    void apply(ConfigStore& store) const;
    void apply_speeds(ConfigStore& store) const;
    void apply_systems(ConfigStore& store) const;
    void apply_signals(ConfigStore& store) const;
    void apply_station(ConfigStore& store) const;
    void apply_motion(ConfigStore& store) const;
    void apply_talker(ConfigStore& store) const;

    const BoardProfile& board_;
    std::uint64_t own_period_ms_;
    SeptentrioState state_;
    SeptentrioSettings factory_, at_start_;
    bool speeds_saved_ = false;
};

}  // namespace skyloop::firmware
