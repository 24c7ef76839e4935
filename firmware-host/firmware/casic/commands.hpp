/// The PCAS commands of receivers with CASIC's chips.
#pragma once

#include "firmware/core/maker.hpp"
#include "firmware/sentences/sentence_settings.hpp"
#include "receiver/protocol/nmea_sentence.hpp"

namespace skyloop::firmware {

/// Executes one. None is acknowledged; PCAS06 alone is answered. What is not known changes nothing.
CommandOutcome execute_pcas(const SentenceView& sentence, const BoardProfile& board, SentenceSettings& store,
                            PortId from);

}  // namespace skyloop::firmware
