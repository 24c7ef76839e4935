/// What leaves a Septentrio receiver at an epoch, by the streams that its user has set up.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "base/core/bytes.hpp"
#include "firmware/messages/sbf_measurement_messages.hpp"
#include "firmware/navigation_state.hpp"
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

}  // namespace skyloop::firmware
