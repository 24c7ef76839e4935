/// RTCM 3 messages 1019, 1020, 1041, 1042, 1044, 1045 and 1046: broadcast orbits and clocks (RTCM 10403.3, tables
/// 3.5-21 and following).
#pragma once

#include <optional>

#include "base/core/bytes.hpp"
#include "base/time/utc_time.hpp"
#include "receiver/protocol/rtcm3.hpp"
#include "world/gnss/ephemeris.hpp"

namespace skyloop::inline receiver {

/// The number of the message that tells a record: 1019 of GPS, 1020 of GLONASS, 1041 of NavIC, 1042 of BeiDou, 1044 of
/// QZSS, 1045 of Galileo F/NAV and 1046 of I/NAV. Nothing for almanacs and SBAS.
std::optional<int> ephemeris_number(const Ephemeris& record);
/// True for those numbers.
bool is_ephemeris_number(int number);

/// The frame. Values that do not fit become the nearest that do. Empty for what has no message.
/// @param sent when the satellite broadcasts it: weeks are of then (DF076, DF289, DF452, DF489, DF517), of GLONASS the
///     date, too
Bytes encode_ephemeris(const Ephemeris& record, GpsTime sent,
                       const LeapSeconds& leap_seconds = LeapSeconds::announced());

/// The record. Accuracies are those of the middle of their index, as RINEX has them. Nothing for other numbers, cut
/// messages, satellites that do not exist, and weeks that are neither that of `near` nor one beside it.
/// @param near an instant within half a week of the record's; of GLONASS within half a day
std::optional<Ephemeris> decode_ephemeris(const Rtcm3Message& message, GpsTime near,
                                          const LeapSeconds& leap_seconds = LeapSeconds::announced());

}  // namespace skyloop::inline receiver
