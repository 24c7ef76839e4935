/// GPS and QZSS CNAV messages of L2C and L5 (IS-GPS-200N, 30.3; IS-GPS-705J, 20.3).
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "base/time/utc_time.hpp"
#include "world/gnss/ephemeris.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop::inline world {

/// A message of 300 bits as u-blox hands it out [seen in captures]: the first bit is the highest of the first word, and
/// the last 20 bits are the first ones of the message that follows.
using CnavWords = std::array<std::uint32_t, 10>;

/// How long a message lasts: 12 s on L2C, 6 s on L5.
std::chrono::seconds cnav_length(Signal signal);

/// The message that a signal sends until an instant: 10 and 11 (ephemeris), 30 (clock, ionosphere, group delays) and 33
/// (clock, UTC) in turn from the start of the week on, as in captures, of which satellites send other ones, too.
/// @param signal Signal::l2 or Signal::l5
std::optional<int> cnav_type_ending(Signal signal, GpsTime end);

/// URA_ED as these messages tell it, −16 … 15, by its upper bounds (IS-GPS-200N, 30.3.3.1.1.4).
int cnav_accuracy_index(double metres);

/// What the messages of a satellite are made from.
struct CnavData {
    const KeplerEphemeris& record;
    const BroadcastIonosphere& ionosphere;
    const LeapSeconds& leap_seconds;
};

/// The messages 10, 11, 30 and 33 (figures 30-1 to 30-3 and 30-6). Of a record of LNAV orbit and clock are the same;
/// the corrections of L2C and L5 are those that the emulated satellite sends with (sent_group_delay()). Values that do
/// not fit become the nearest that do.
/// @param end when the message ends, which is what it tells
CnavWords cnav_message(const CnavData& data, int type, Signal signal, GpsTime end);

}  // namespace skyloop::inline world
