/// Galileo I/NAV pages of E1-B and E5b-I (OS SIS ICD 2.0, section 4.3).
/// BeiDou D1 navigation subframes of MEO and IGSO satellites (BDS-SIS-ICD B1I 3.0, section 5.2).
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "base/time/utc_time.hpp"
#include "world/gnss/ephemeris.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop::inline world {

/// An even and an odd page as u-blox hands them out [seen in captures]: four words each, 120 bits and 8 of 0.
using InavWords = std::array<std::uint32_t, 8>;

/// What the words of a satellite are made from.
struct InavData {
    const KeplerEphemeris& record;
    const BroadcastIonosphere& ionosphere;
    const LeapSeconds& leap_seconds;
};

/// The word that a signal sends in the pair of pages that ends with an instant, in the order of a nominal subframe of
/// 30 s (tables 37 and 38). Almanacs (words 7 to 10) and what the ICD reserves are sent as spare words.
/// @param signal Signal::l1 or Signal::e5b
/// @return 0 … 6; nothing when no pair ends then: they are of 2 s from the start of the week on with E5b-I, from a
/// second
///     later on with E1-B, as in captures (word 5 tells 25 s of each 30, word 6 tells 5 s)
std::optional<int> inav_word_ending(Signal signal, GpsTime end);

/// SISA as word 3 tells it: 0 … 125, 255 for none (table 82).
int inav_accuracy_index(double metres);

/// The pair of pages with the words 1 to 6 (tables 39 to 45) or the spare word 0 with its time. Values that do not fit
/// become the nearest that do.
InavWords inav_pages(const InavData& data, int word, GpsTime end);

/// Ten words as u-blox hands them out [seen in captures]: 30 bits in bits 29 … 0, the interleaving undone: 26 or 22
/// bits of information, then 4 or twice 4 of parity.
using D1Words = std::array<std::uint32_t, 10>;

/// Subframes 1 to 3: clock, ionosphere and ephemeris (figures 5-8 to 5-10, tables 5-6 to 5-13). Values that do not fit
/// become the nearest that do.
/// @param ionosphere of BeiDou; absent: zeros
/// @param subframe 1 … 3
/// @param end when the subframe ends; it tells of its start
D1Words d1_subframe(const KeplerEphemeris& record, const std::optional<KlobucharCoefficients>& ionosphere, int subframe,
                    GpsTime end);

}  // namespace skyloop::inline world
