/// GLONASS navigation strings (ICD L1, L2 GLONASS 5.1, section 4).
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>

#include "base/time/utc_time.hpp"
#include "world/gnss/ephemeris.hpp"

namespace skyloop::inline world {

/// The 85 bits of a string, bit 85 in the highest bit of the first word; in the last word the number of the superframe
/// since the start of GLONASS time's week, from 1 on, times 65536, plus that of the frame, 1 … 5 [seen in captures].
using GlonassWords = std::array<std::uint32_t, 4>;

/// The string that ends with an instant.
/// @return 1 … 15; nothing when no string ends then: they are of 2 s from the start of the day of UTC + 3 h on
std::optional<int> glonass_string_ending(GpsTime end, const LeapSeconds& leap_seconds);

/// One of the strings 1 to 5 (tables 4.5 and 4.9): state vector, clock, time. Values that do not fit become the
/// nearest that do. @param end when it ends
GlonassWords glonass_string(const GlonassEphemeris& record, int string, GpsTime end, const LeapSeconds& leap_seconds);

/// What the strings 6 to 15 tell of one satellite (section 4.5, table 4.9).
struct GlonassAlmanac {
    SatelliteId satellite;
    int frequency_channel = 0;
    bool healthy = true;
    double time_correction = 0;  ///< τ^A, s
    double node_longitude = 0;   ///< λ^A at node_time, rad
    double node_time = 0;        ///< t_λ^A: of the first ascending node of the day of GLONASS time, s
    double inclination = 0;      ///< rad
    double eccentricity = 0;
    double perigee = 0;          ///< ω^A, rad
    double draconic_period = 0;  ///< from node to node, s
};

/// The almanac of a satellite for the day of an instant. The orbit is followed from the record to the next two
/// ascending nodes (A.3.1.2 without Moon and Sun), and taken from there to the first node of the day; good to some
/// kilometres. Nothing for a record that is no orbit of a satellite of the system.
std::optional<GlonassAlmanac> glonass_almanac(const GlonassEphemeris& record, GpsTime day,
                                              const LeapSeconds& leap_seconds);

/// Almanacs as satellites send them: five in each frame, four in the fifth.
///
/// State: the almanacs of records at hand, so that each orbit is followed once. No answer depends on what was asked
/// before.
class GlonassAlmanacStrings {
public:
    /// @param sender whose health the odd strings tell
    /// @param string 6 … 15; 14 and 15 of the fifth frame are without an almanac, and 0
    /// @param end when it ends
    GlonassWords at(const NavigationSource& source, const GlonassEphemeris& sender, int string, GpsTime end,
                    const LeapSeconds& leap_seconds);

private:
    struct Known {
        GpsTime toe, day;
        std::optional<GlonassAlmanac> almanac;
    };
    const std::optional<GlonassAlmanac>& of(const GlonassEphemeris& record, GpsTime day,
                                            const LeapSeconds& leap_seconds);

    std::map<SatelliteId, Known> known_;
};

}  // namespace skyloop::inline world
