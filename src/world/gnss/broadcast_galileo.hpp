/// Galileo I/NAV pages of E1-B and E5b-I, F/NAV pages of E5a-I (OS SIS ICD 2.1, sections 4.2 and 4.3).
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "base/core/bytes.hpp"
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
    const NavigationSource* almanacs = nullptr;  ///< of all satellites; null: they tell of none
    std::uint64_t authentication = 0;            ///< the 40 bits of the odd page that OSNMA has; of E5b reserved
};

/// The word that a signal sends in the pair of pages that ends with an instant, in the order of two nominal subframes
/// of 30 s (tables 40 and 41; which of them come in which half of a minute as in captures). What the ICD reserves is
/// sent as spare words.
/// @param signal Signal::l1 or Signal::e5b
/// @return 0 … 10 and 16 … 20; nothing when no pair ends then: they are of 2 s from the start of the week on with
///     E5b-I, from a second later on with E1-B, as in captures (word 5 tells 25 s of each 30, word 6 tells 5 s)
std::optional<int> inav_word_ending(Signal signal, GpsTime end);

/// SISA as word 3 tells it: 0 … 125, 255 for none (table 82).
int inav_accuracy_index(double metres);

/// The word of a satellite that has nothing to tell.
inline constexpr int dummy_inav_word = 63;

/// The 128 bits of a word (tables 42 to 58). @param start of its pair of pages
BitWriter inav_word(const InavData& data, int word, GpsTime start);

/// The pair of pages with the words 1 to 6 (ephemeris, ionosphere, UTC), 7 to 10 (almanacs), 16 (reduced record), 17 to
/// 20 (octets that mend the words 1 to 4), 63, or the spare word 0 with its time. Values that do not fit become the
/// nearest that do.
InavWords inav_pages(const InavData& data, int word, GpsTime end);

/// The 40 bits of the odd page that OSNMA has.
std::uint64_t inav_authentication(const InavWords& pages);
/// The same pages with others there, and their checksum.
InavWords with_authentication(const InavWords& pages, std::uint64_t authentication);

/// A page of F/NAV as u-blox hands it out [seen in captures]: 214 bits, 24 of checksum, 6 of tail, 12 of 0.
using FnavWords = std::array<std::uint32_t, 8>;

/// The page of F/NAV that ends with an instant: 1 to 4, then 5 and 6 in turn, of 10 s from the start of the week on
/// (section 4.2.4); satellites with odd numbers send 5 where the others send 6 [seen in captures].
std::optional<int> fnav_page_ending(SatelliteId satellite, GpsTime end);

/// Pages 1 to 4 (clock, ephemeris, ionosphere, UTC) and 5 and 6 (almanacs) of F/NAV. The clock of a record that came by
/// I/NAV becomes that of E1 and E5a.
FnavWords fnav_page(const InavData& data, int page, GpsTime end);

}  // namespace skyloop::inline world
