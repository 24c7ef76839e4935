/// What NMEA sentences of a client do: PUBX, standard polls, PMTK, PAIR.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/bytes.hpp"
#include "firmware/board_profile.hpp"
#include "firmware/config/config_store.hpp"
#include "firmware/port_id.hpp"
#include "receiver/protocol/nmea_sentence.hpp"
#include "world/flow/receiver_settings.hpp"

namespace skyloop::firmware {

/// What came of a sentence.
struct CommandOutcome {
    std::vector<Bytes> answers;        ///< whole sentences, in this order
    std::vector<UbxMessageId> polled;  ///< messages to be sent once, after the answers (classes F0, F1)
    std::optional<StartKind> restart;  ///< the receiver starts anew
    std::optional<bool> positioning;   ///< it goes on tracking and solving, or stops; it answers all the same
    bool standby = false;              ///< it is off until a byte comes
};

/// A maker's numbered command while it is answered.
struct NumberedCommand {
    const SentenceView& sentence;
    const BoardProfile& board;
    ConfigStore& store;
    PortId from;
    int number = 0;
    CommandOutcome outcome{};

    [[nodiscard]] std::optional<int> argument(std::size_t i) const;
    /// @param body of a sentence, without "$" and checksum
    void answer(const std::string& body);
};

/// Executes one checked sentence by the board's personality; what it configures is in the store afterwards, port
/// speeds among it (RECEIVER.md 5.7 to 5.9). A sentence that means nothing gives an empty outcome, or what the board
/// says to such.
CommandOutcome execute_sentence(const SentenceView& sentence, const BoardProfile& board, ConfigStore& store,
                                PortId from);

// Each personality's own commands.
CommandOutcome execute_ublox(const SentenceView& sentence, const BoardProfile& board, ConfigStore& store, PortId from);
CommandOutcome execute_pmtk(const SentenceView& sentence, const BoardProfile& board, ConfigStore& store, PortId from);
CommandOutcome execute_pair(const SentenceView& sentence, const BoardProfile& board, ConfigStore& store, PortId from);

/// Where corrections come from, as MediaTek and Airoha number it.
enum class AidingSource { none = 0, rtcm = 1, sbas = 2 };
AidingSource correction_source(const ConfigStore& store, PortId from);
void set_correction_source(ConfigStore& store, PortId from, AidingSource source);

/// Sets systems in the order of `systems`, one for each of `wanted`; false, and nothing changed, when none of the
/// major systems would be left or a system is wanted that the board cannot track.
bool set_systems(const BoardProfile& board, ConfigStore& store, ConfigLayers layers,
                 const std::vector<std::pair<Constellation, bool>>& wanted);

/// The board's version answers that begin with "$" and `prefix`, as sentences.
std::vector<Bytes> version_answers(const BoardProfile& board, std::string_view prefix);

/// The shortest time between two fixes that the board can be asked for, ms.
int least_fix_interval(const BoardProfile& board);

}  // namespace skyloop::firmware
