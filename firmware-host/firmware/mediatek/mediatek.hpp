/// MediaTek's receivers: sentences, PMTK commands.
#pragma once

#include "firmware/core/maker.hpp"

namespace skyloop::firmware {

std::unique_ptr<Maker> make_mediatek(const BoardProfile& board, const ReceiverOptions& options);

}  // namespace skyloop::firmware
