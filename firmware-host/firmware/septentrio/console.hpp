/// The command line of a Septentrio receiver (mosaic-X5 reference guide, firmware 4.14, chapter 3).
/// What leaves a Septentrio receiver at an epoch, by the streams that its user has set up.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/bytes.hpp"
#include "firmware/messages/sbf_messages.hpp"
#include "firmware/navigation_state.hpp"
#include "firmware/nmea_commands.hpp"
#include "firmware/septentrio/settings.hpp"
#include "receiver/protocol/sbf_cartesian_blocks.hpp"

namespace skyloop::firmware {

/// A record as its satellite numbers it: which one it is; and its health, which may change without a new number.
struct RecordIssue {
    GpsTime toe;
    int iode = 0, iodc = 0;
    bool healthy = true;
    bool operator==(const RecordIssue&) const = default;
};

/// The receiver behind its command line.
struct SeptentrioState {
    SeptentrioSettings settings;
    bool disk_mounted = true;
    std::uint8_t commands = 0;  ///< so many, from 255 on to 1: 0 is none yet
    // Of the measurements and messages of the epochs so far.
    SbfMeasurementCounts counts{};
    std::optional<GpsTime> last_epoch{};
    std::map<SatelliteId, RecordIssue> told_records{};  ///< since the streams were last changed
    std::vector<Bytes> new_records{};                   ///< blocks of the last epoch
    std::optional<Bytes> told_setup{};                  ///< since the streams were last changed
    bool setup_changed = false;                         ///< at the last epoch
};

/// Takes an epoch in before its blocks are made; the same one again changes nothing.
void follow_epoch(SeptentrioState& receiver, const BoardProfile& board, const NavigationState& state);

/// ReceiverSetup as the settings have it.
SbfReceiverSetup sbf_receiver_setup(const SeptentrioSettings& settings, const BoardProfile& board);

/// Whether a stream asks for what comes by navigation messages.
bool wants_messages(const SeptentrioSettings& settings);

/// Blocks, sentences and RTCM 3 that are due at an epoch on the port of `context`, in this order. Blocks that this
/// receiver does not make are left out. What several streams ask for leaves once.
std::vector<Bytes> septentrio_output(const SeptentrioState& receiver, const ReportContext& context);

/// Period at which solutions are needed, ms, so that each stream finds its epochs; nothing when none asks for a certain
/// one. @param own period of the receiver by itself, at which streams OnChange send
std::optional<std::uint64_t> wanted_period_ms(const SeptentrioSettings& settings, std::uint64_t own);

/// Whether something is written to the disk: a stream goes there.
bool logs_to_disk(const SeptentrioSettings& settings);

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
