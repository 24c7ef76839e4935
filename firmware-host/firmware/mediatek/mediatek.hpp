/// MediaTek's receivers: sentences, PMTK commands.
#pragma once

#include "firmware/core/maker.hpp"

namespace skyloop::firmware {

std::unique_ptr<Maker> make_mediatek(const BoardProfile& board, const ReceiverOptions& options);
Abilities mediatek_abilities(const BoardProfile& board);

}  // namespace skyloop::firmware
