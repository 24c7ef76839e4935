/// What NMEA sentences of a client do: PUBX, standard polls, PMTK, PAIR.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/board_profile.hpp"
#include "firmware/config/config_store.hpp"
#include "firmware/port_id.hpp"
#include "skyloop/flow/receiver_settings.hpp"
#include "skyloop/protocol/nmea_sentence.hpp"

namespace skyloop::firmware {

/// What came of a sentence.
struct CommandOutcome {
    std::vector<Bytes> answers;        ///< whole sentences, in this order
    std::vector<UbxMessageId> polled;  ///< messages to be sent once, after the answers (classes F0, F1)
    std::optional<StartKind> restart;  ///< the receiver starts anew
};

/// Executes one checked sentence by the board's personality; what it configures is in the store afterwards, port
/// speeds among it (RECEIVER.md 5.7 to 5.9). A sentence that means nothing gives an empty outcome, or what the board
/// says to such.
CommandOutcome execute_sentence(const SentenceView& sentence, const BoardProfile& board, ConfigStore& store,
                                PortId from);

}  // namespace skyloop::firmware
