/// What all subframes of BeiDou's D1 and D2 have in common (BDS-SIS-ICD B1I 3.0, section 5).
#pragma once

#include "base/core/bytes.hpp"
#include "world/gnss/broadcast_beidou.hpp"

namespace skyloop::inline world {

/// Preamble, number and time. @param sow what is told of the time: the start of the subframe, of D2 that of its frame
void put_beidou_head(BitWriter& bits, int subframe, GpsTime sow);

/// 224 bits with their parity.
D1Words with_d1_parity(const BitWriter& bits);

}  // namespace skyloop::inline world
