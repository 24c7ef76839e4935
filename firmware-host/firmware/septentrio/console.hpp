/// The command line of a Septentrio receiver (mosaic-X5 reference guide, firmware 4.14, chapter 3).
/// What leaves a Septentrio receiver at an epoch, by the streams that its user has set up.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/core/bytes.hpp"
#include "firmware/core/factory_settings.hpp"
#include "firmware/core/maker.hpp"
#include "firmware/core/navigation_state.hpp"
#include "firmware/septentrio/sbf_messages.hpp"
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
    std::map<SatelliteId, RecordIssue> told_records{};                         ///< since the streams were last changed
    std::map<std::pair<SatelliteId, NavigationMessage>, Ephemeris> records{};  ///< the last of each that was whole
    std::vector<Bytes> new_records{};                                          ///< blocks of the last epoch
    std::optional<Bytes> told_setup{};                                         ///< since the streams were last changed
    bool setup_changed = false;                                                ///< at the last epoch
};

/// Takes an epoch in before its blocks are made; the same one again changes nothing.
void follow_epoch(SeptentrioState& receiver, const BoardProfile& board, const NavigationState& state);

/// ReceiverSetup as the settings have it.
SbfReceiverSetup sbf_receiver_setup(const SeptentrioSettings& settings, const BoardProfile& board);

/// Whether a stream, or a message for rovers, asks for what comes by navigation messages.
bool wants_messages(const SeptentrioSettings& settings);

/// Blocks, sentences and RTCM 3 that are due at an epoch on the port of `context`, in this order. Blocks that this
/// receiver does not make are left out. What several streams ask for leaves once.
std::vector<Bytes> septentrio_output(const SeptentrioState& receiver, const ReportContext& context);

/// Period at which solutions are needed, ms, so that each stream finds its epochs; nothing when none asks for a certain
/// one. @param own period of the receiver by itself, at which streams OnChange send
std::optional<std::uint64_t> wanted_period_ms(const SeptentrioSettings& settings, std::uint64_t own);

/// Whether something is written to the disk: a stream goes there.
bool logs_to_disk(const SeptentrioSettings& settings);

/// What a Septentrio receiver does by its settings. Systems and signals are kept apart: one that is off keeps its
/// signals.
struct SeptentrioTarget {
    ReceiverConfig config;
    std::set<Constellation> systems;  ///< that are on
    std::set<SystemSignal> signals;   ///< of all systems
    static SeptentrioTarget at_start(const BoardProfile& board, const ReceiverOptions& options);
    /// Systems and signals of `config`, by those that are on.
    void put_signals(const SeptentrioTarget& start);
};

/// Executes lines: settings (`setXxx`, `getXxx`), actions (`exeXxx`), lists (`lstXxx`), by name or mnemonic.
/// State: the settings in force, those of the next start, the disk.
class SeptentrioConsole {
public:
    /// @param board it must outlive this @param start how the receiver begins
    SeptentrioConsole(const BoardProfile& board, const SeptentrioTarget& start);

    /// Answers end with the prompt; a wrong command is answered, a line of ten S takes the port back for commands.
    /// @param to what the receiver does, which follows the settings
    CommandOutcome execute(const std::string& line, SeptentrioTarget& to, PortId from);
    /// After a restart the saved settings hold.
    void restart(SeptentrioTarget& to);
    /// All settings are as at the factory.
    void forget(SeptentrioTarget& to);
    /// The configuration of the next start as far as it is not the factory's: a line "SBFOutput, Stream1, COM1, …"
    /// each.
    [[nodiscard]] std::string boot_text() const;
    /// Takes it, and begins with it. Fails with `input`, naming the line.
    Result<void> load(const std::string& text, const std::string& name, SeptentrioTarget& to);
    /// Takes an epoch in before what is due is made from it.
    void follow(const NavigationState& state) { follow_epoch(state_, board_, state); }
    [[nodiscard]] const SeptentrioState& state() const { return state_; }

private:
    struct Command;
    std::string answer(const Command& command, SeptentrioTarget& to, CommandOutcome& outcome);
    std::string act(const Command& command, CommandOutcome& outcome);
    std::string act_on_receiver(const Command& command, CommandOutcome& outcome);
    [[nodiscard]] std::string capabilities() const;
    [[nodiscard]] std::string identification() const;
    [[nodiscard]] bool lets_in(PortId port, std::string_view input) const;
    void adopt();
    void apply(SeptentrioTarget& to) const;
    void apply_speeds(SeptentrioTarget& to) const;
    void apply_systems(SeptentrioTarget& to) const;
    void apply_signals(SeptentrioTarget& to) const;
    void apply_station(SeptentrioTarget& to) const;
    void apply_motion(SeptentrioTarget& to) const;
    void apply_talker(SeptentrioTarget& to) const;

    const BoardProfile& board_;
    SeptentrioTarget start_;
    SeptentrioState state_;
    SeptentrioSettings factory_, at_start_;
    bool speeds_saved_ = false;
};

}  // namespace skyloop::firmware
