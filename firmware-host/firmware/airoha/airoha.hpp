/// Airoha's receivers: sentences, PAIR commands.
#pragma once

#include "firmware/core/maker.hpp"

namespace skyloop::firmware {

std::unique_ptr<Maker> make_airoha(const BoardProfile& board, const ReceiverOptions& options);
Abilities airoha_abilities(const BoardProfile& board);

}  // namespace skyloop::firmware
