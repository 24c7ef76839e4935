/// Airoha's receivers: sentences, PAIR commands.
#pragma once

#include "firmware/core/maker.hpp"
#include "firmware/sentences/sentence_settings.hpp"
#include "receiver/protocol/nmea_sentence.hpp"

namespace skyloop::firmware {

/// Executes a PAIR command.
CommandOutcome execute_pair(const SentenceView& sentence, const BoardProfile& board, SentenceSettings& store,
                            PortId from);

std::unique_ptr<Maker> make_airoha(const BoardProfile& board, const ReceiverOptions& options);
Abilities airoha_abilities(const BoardProfile& board);

}  // namespace skyloop::firmware
