/// BeiDou navigation subframes of B1I: D1 of MEO and IGSO satellites, D2 of geostationary ones (BDS-SIS-ICD B1I 3.0,
/// sections 5.2 and 5.3).
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>

#include "base/time/utc_time.hpp"
#include "world/gnss/ephemeris.hpp"

namespace skyloop::inline world {

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

/// A subframe of D2 lasts 0.6 s, a frame of five of them 3 s.
inline constexpr std::chrono::milliseconds d2_subframe_length{600};
/// Pages of subframe 1, one each frame; together a record.
inline constexpr int d2_page_count = 10;

/// The page 1 … 10 of the subframe 1 of D2 that ends with an instant, 0.6 s after each third second of BDT.
std::optional<int> d2_page_ending(GpsTime end);

/// Subframe 1 of D2: clock, ionosphere and ephemeris in ten pages (section 5.3.2, figures 5-14-1 to 5-14-10).
/// @param ionosphere of BeiDou; absent: zeros
/// @param page 1 … 10
/// @param end when the subframe ends; it tells of its start
D1Words d2_page(const KeplerEphemeris& record, const std::optional<KlobucharCoefficients>& ionosphere, int page,
                GpsTime end);

/// What the satellites tell of each other and of UTC.
struct BeidouSystemData {
    const NavigationSource* source = nullptr;  ///< null: almanacs of nobody
    const LeapSeconds& leap_seconds;
};

/// Subframes 4 and 5 of D1 (section 5.2.4.14 to 5.2.4.19, figures 5-11 and 5-12): a page each frame, 24 of them in
/// twelve minutes; almanacs of C01 to C30, in three times twelve minutes those of C31 to C63, health, and UTC. What
/// almanacs tell is of the last whole 4096 s; satellites without a record have zeros.
/// @param subframe 4 or 5
/// @param end when the subframe ends
D1Words d1_system_subframe(const BeidouSystemData& data, int subframe, GpsTime end);

/// The same in subframe 5 of D2, of which a frame each 3 s has one, in six minutes (section 5.3.3, table 5-17). Nothing
/// where none ends, and for pages of the ionospheric grid and reserved ones.
std::optional<D1Words> d2_system_subframe_ending(const BeidouSystemData& data, GpsTime end);

}  // namespace skyloop::inline world
