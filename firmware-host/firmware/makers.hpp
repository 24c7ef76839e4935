/// The factory: which makers there are. Nothing else asks which one a receiver has.
#pragma once

#include <span>

#include "firmware/core/maker.hpp"

namespace skyloop::firmware {

/// In the order of MakerKind, each named as by the key `personality` of board files.
std::span<const MakerRow> maker_rows();
/// The row of a kind of receiver.
const MakerRow& maker_row(MakerKind kind);
Abilities abilities(const BoardProfile& board);

}  // namespace skyloop::firmware
