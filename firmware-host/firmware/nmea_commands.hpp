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
    /// Nothing as well for one that is not among least … most.
    [[nodiscard]] std::optional<int> argument_within(std::size_t i, int least, int most) const;
    /// @param body of a sentence, without "$" and checksum
    void answer(const std::string& body);
    /// The time between two fixes, ms. False, and nothing changed, for one that the board cannot do.
    bool set_fix_interval(ConfigLayers layers, int period);
    [[nodiscard]] std::uint64_t fix_interval() const;
    /// Every how many epochs the port sends a sentence, "GGA"; nothing for a name that stands for none.
    [[nodiscard]] std::optional<std::uint32_t> sentence_item(std::string_view name) const;
};

/// A row of the tables that say which function executes which command.
template <class Command>
struct CommandRow {
    int number;
    void (*execute)(Command&);
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

}  // namespace skyloop::firmware
