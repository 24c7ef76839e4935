/// The messages of satellite-based augmentation, as 250 bits of one second.
/// Where the messages come from.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "base/time/gps_time.hpp"
#include "world/gnss/ephemeris.hpp"

namespace skyloop::inline world {

// Layouts: RTCA DO-229, appendix A; ICAO Annex 10, volume I, appendix B, 3.5.4 to 3.5.6, whose tables name the fields.
// Numbers are in the units of those tables; fields that a number does not fit hold the nearest that does.

/// 250 bits, first one first; the last six are 0.
using SbasWords = std::array<std::uint32_t, 8>;

inline constexpr int sbas_mask_size = 210;         ///< slots of the PRN mask
inline constexpr std::size_t sbas_corrected = 51;  ///< satellites that a mask may name
inline constexpr std::size_t sbas_block = 13;      ///< satellites of one message of fast corrections
inline constexpr int udrei_not_monitored = 14, udrei_do_not_use = 15;
inline constexpr int givei_not_monitored = 15;

/// The slot of the PRN mask of a satellite: GPS 1 … 37, GLONASS 38 … 61, SBAS 120 … 158; of other systems none.
std::optional<int> sbas_mask_slot(SatelliteId satellite);

/// Message 1: which satellites the others speak of.
struct SbasPrnMask {
    std::vector<int> slots{};  ///< ascending, 1 … sbas_mask_size
    int iodp = 0;
    bool operator==(const SbasPrnMask&) const = default;
};

struct SbasFastCorrection {
    double range_m = 0;  ///< to be added to the pseudorange
    int udrei = udrei_not_monitored;
    bool operator==(const SbasFastCorrection&) const = default;
};

/// Messages 2 to 5: corrections of 13 satellites each, in the order of the mask.
struct SbasFastCorrections {
    int block = 0;  ///< 0 … 3; the message's type less 2
    int iodf = 0, iodp = 0;
    std::array<SbasFastCorrection, sbas_block> satellites{};
    bool operator==(const SbasFastCorrections&) const = default;
};

/// Message 0: whoever sends it must not be used. In a test it holds what message 2 would; else nothing.
struct SbasDoNotUse {
    std::optional<SbasFastCorrections> test{};
    bool operator==(const SbasDoNotUse&) const = default;
};

/// Message 6: the error bounds of all satellites of the mask.
struct SbasIntegrity {
    std::array<int, 4> iodf{};  ///< of each block; 3: whatever its corrections
    std::array<int, sbas_corrected> udrei{};
    bool operator==(const SbasIntegrity&) const = default;
};

/// Message 7: how fast corrections age.
struct SbasFastDegradation {
    int latency_s = 0, iodp = 0;
    std::array<int, sbas_corrected> indicators{};
    bool operator==(const SbasFastDegradation&) const = default;
};

/// Message 9: where the satellite itself is.
struct SbasNavigation {
    int issue = 0;
    double time_of_day_s = 0;  ///< t_0
    int accuracy_index = 15;
    std::array<double, 3> position_m{}, velocity_mps{}, acceleration_mps2{};
    double clock_bias = 0, clock_drift = 0;
    bool operator==(const SbasNavigation&) const = default;
};

/// Message 10: how all else ages. Names as in the tables.
struct SbasDegradation {
    double b_rrc_m = 0, c_ltc_lsb_m = 0, c_ltc_v1_mps = 0;
    int i_ltc_v1_s = 0;
    double c_ltc_v0_m = 0;
    int i_ltc_v0_s = 0;
    double c_geo_lsb_m = 0, c_geo_v_mps = 0;
    int i_geo_s = 0;
    double c_er_m = 0, c_iono_step_m = 0;
    int i_iono_s = 0;
    double c_iono_ramp_mps = 0;
    int rss_udre = 0, rss_iono = 0;
    double c_covariance = 0;
    bool operator==(const SbasDegradation&) const = default;
};

/// One satellite of message 17.
struct SbasAlmanac {
    int data_id = 0, prn = 0;  ///< PRN 0: nothing
    int health = 0;            ///< bits: 0 no ranging, 1 no corrections, 2 no integrity, 4-7 the provider
    std::array<double, 3> position_m{}, velocity_mps{};
    bool operator==(const SbasAlmanac&) const = default;
};

/// Message 17.
struct SbasAlmanacs {
    std::array<SbasAlmanac, 3> satellites{};
    double time_of_day_s = 0;
    bool operator==(const SbasAlmanacs&) const = default;
};

/// Message 18: which points of one band of the ionosphere's grid there are.
struct SbasGridMask {
    int bands = 0;  ///< that are sent
    int band = 0;   ///< 0 … 10
    int iodi = 0;
    std::vector<int> points{};  ///< ascending, 1 … 201
    bool operator==(const SbasGridMask&) const = default;
};

/// What is to be added to a satellite's broadcast position and clock.
struct SbasLongTermCorrection {
    int number = 0;  ///< in the order of the mask, from 1 on; 0: nothing
    int iode = 0;    ///< of the record that is corrected
    std::array<double, 3> position_m{};
    double clock_s = 0;
    std::array<double, 3> velocity_mps{};  ///< with velocity code 1 alone, as the next two
    double clock_drift = 0;
    double time_of_day_s = 0;
    bool operator==(const SbasLongTermCorrection&) const = default;
};

/// Half of message 25: one satellite with its velocity, or two without.
struct SbasLongTermHalf {
    bool with_velocity = false;
    int iodp = 0;
    std::array<SbasLongTermCorrection, 2> satellites{};
    bool operator==(const SbasLongTermHalf&) const = default;
};

/// Message 24: fast corrections of six satellites, and half a message 25.
struct SbasMixedCorrections {
    std::array<SbasFastCorrection, 6> satellites{};
    int iodp = 0, block = 0, iodf = 0;
    SbasLongTermHalf long_term{};
    bool operator==(const SbasMixedCorrections&) const = default;
};

/// Message 25.
struct SbasLongTermCorrections {
    std::array<SbasLongTermHalf, 2> halves{};
    bool operator==(const SbasLongTermCorrections&) const = default;
};

struct SbasGridDelay {
    std::optional<double> vertical_m{};  ///< at L1; nothing: not to be used
    int givei = givei_not_monitored;
    bool operator==(const SbasGridDelay&) const = default;
};

/// Message 26: delays at 15 points of a band, in the order of its mask.
struct SbasIonosphere {
    static constexpr std::size_t size = 15;
    int band = 0, block = 0, iodi = 0;
    std::array<SbasGridDelay, size> points{};
    bool operator==(const SbasIonosphere&) const = default;
};

struct SbasRegion {
    int first_latitude = 0, first_longitude = 0, second_latitude = 0, second_longitude = 0;  ///< degrees
    bool square = false;                                                                     ///< else a triangle
    bool operator==(const SbasRegion&) const = default;
};

/// Message 27: where the bounds hold, and by what they grow elsewhere.
struct SbasServiceRegions {
    int issue = 0, messages = 0, number = 0;  ///< messages and number count from 0
    int region_count = 0, priority = 0, udre_inside = 0, udre_outside = 0;
    std::array<SbasRegion, 5> regions{};
    bool operator==(const SbasServiceRegions&) const = default;
};

/// Message 63: nothing.
struct SbasNull {
    bool operator==(const SbasNull&) const = default;
};

using SbasMessage = std::variant<SbasDoNotUse, SbasPrnMask, SbasFastCorrections, SbasIntegrity, SbasFastDegradation,
                                 SbasNavigation, SbasDegradation, SbasAlmanacs, SbasGridMask, SbasMixedCorrections,
                                 SbasLongTermCorrections, SbasIonosphere, SbasServiceRegions, SbasNull>;

/// Its number in the standard.
int sbas_message_type(const SbasMessage& message);

/// @param start of the first bit, which tells which third of the preamble it is: 0x53, 0x9A, 0xC6, the first of them at
/// a whole multiple of three seconds of the week
SbasWords encode_sbas(const SbasMessage& message, GpsTime start);
/// @return nothing for another preamble or type, or a parity that is wrong
std::optional<SbasMessage> decode_sbas(const std::vector<std::uint32_t>& words);

/// The bound of a satellite's error, m, at 99.9 % and the smallest index whose bound holds `bound`; 13 beyond all.
/// @param index 0 … 13
double sbas_udre(int index);
int sbas_udre_index(double bound);
/// The same of the ionosphere at a point of the grid. @param index 0 … 14, which is the last
double sbas_give(int index);
int sbas_give_index(double bound);
/// A bound over the deviation that it is of.
inline constexpr double sbas_bound_factor = 3.29;

/// What an aged correction may still be used for, by message 7, s: en route and non-precision approach.
/// @param indicator 0 … 15
Seconds sbas_fast_timeout(int indicator);

/// Message 9 of a record.
SbasNavigation sbas_navigation(const SbasEphemeris& record);

/// What SBAS satellites send.
class SbasSource {
public:
    virtual ~SbasSource() = default;
    /// The message that ends at a whole second; nothing where the satellite sends none. Instants of one satellite come
    /// in ascending order.
    virtual std::optional<SbasWords> message(SatelliteId satellite, GpsTime end) = 0;
};

}  // namespace skyloop::inline world
