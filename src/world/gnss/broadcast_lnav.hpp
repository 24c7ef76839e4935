/// GPS and QZSS legacy navigation subframes (IS-GPS-200, 20.3).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/time/utc_time.hpp"
#include "world/gnss/ephemeris.hpp"

namespace skyloop::inline world {

/// The 24 data bits of each of the ten words of a subframe; parity comes later.
using LnavData = std::array<std::uint32_t, 10>;

/// Words as u-blox hands them out [seen in captures]: in bits 29 … 0 a word whose data bits are upright, in bits 31 and
/// 30 the last two bits of the word before; all 32 bits are inverted where the last of those two was 1.
using LnavWords = std::array<std::uint32_t, 10>;

/// Parity by IS-GPS-200, table 20-XIV; the last two data bits of words 2 and 10 are solved so that the word ends in 00.
LnavWords lnav_words(const LnavData& data);

/// Subframes 1 to 3: clock and ephemeris (IS-GPS-200, 20.3.3.3 and 20.3.3.4). Values that do not fit become the nearest
/// that do.
/// @param subframe 1 … 3
/// @param end when the subframe ends, which is what its hand-over word tells
LnavWords lnav_ephemeris_subframe(const KeplerEphemeris& record, int subframe, GpsTime end);

/// URA as these subframes tell it, 0 … 15, by its upper bounds (IS-GPS-200, 20.3.3.3.1.3); of BeiDou, which has taken
/// them over, URAI (B1I ICD 3.0, 5.2.4.5).
int lnav_accuracy_index(double metres);

/// What pages of subframes 4 and 5 tell of the whole system.
struct LnavSystemData {
    const NavigationSource* source = nullptr;  ///< of almanacs and health
    LeapSeconds leap_seconds = LeapSeconds::announced();
    Constellation of = Constellation::gps;  ///< gps or qzss
};

/// Subframes 4 and 5 with the page that belongs to their time, 25 pages in 12.5 minutes from the start of the week:
/// almanacs (20.3.3.5.1.2), health (20.3.3.5.1.3), ionosphere and UTC on page 18 of subframe 4 (20.3.3.5.1.6 and .7);
/// alternating bits on all others and for satellites that the source does not have. An almanac is made from the
/// satellite's record. QZSS tells of its own: data id 3, almanacs of ten satellites and their health in subframe 5, its
/// own ionosphere, and nothing else (IS-QZSS-PNT, LNAV).
/// @param subframe 4 or 5
LnavWords lnav_system_subframe(const LnavSystemData& system, int subframe, GpsTime end);

}  // namespace skyloop::inline world
