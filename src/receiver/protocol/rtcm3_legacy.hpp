/// RTCM 3 observables of GPS and GLONASS as they were before multiple signal messages: 1001–1004 and 1009–1012
/// (RTCM 10403.3, tables 3.5-1 to 3.5-5 and 3.5-9 to 3.5-13).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/core/bytes.hpp"
#include "receiver/protocol/rtcm3.hpp"

namespace skyloop::inline receiver {

/// One carrier of one satellite.
struct Rtcm3LegacyCarrier {
    /// On L1 0 is C/A and 1 is P (DF010, DF039); on L2 0 is C/A or L2C, 1 P, 2 and 3 P by correlation (DF016, DF046).
    int code = 0;
    std::optional<double> range_m;        ///< pseudorange
    std::optional<double> phase_range_m;  ///< carrier phase times its wavelength, growing with the range
    double wavelength_m = 0.19;           ///< for the encoder: whole cycles bring a phase within reach of its field
    double lock_s = 0;                    ///< without a break of the phase
    double cno_dbhz = 0;                  ///< 0: not told, as in the basic messages
};

/// One satellite.
struct Rtcm3LegacySatellite {
    /// DF009: of GPS 1 … 32, of SBAS the PRN − 80, 40 … 58. DF038: the slot of GLONASS 1 … 24, 0 for an unknown one.
    int satellite = 1;
    int frequency_channel = 0;  ///< of GLONASS −7 … +13 (DF040)
    Rtcm3LegacyCarrier l1;
    std::optional<Rtcm3LegacyCarrier> l2;  ///< of 1003, 1004, 1011 and 1012
};

/// All that one message tells.
struct Rtcm3LegacyObservables {
    int number = 1004;
    int station = 0;          ///< DF003
    std::uint32_t epoch = 0;  ///< ms of the GPS week (DF004) or of the GLONASS day, UTC + 3 h (DF034)
    bool more = false;        ///< more messages of the same epoch follow (DF005)
    std::vector<Rtcm3LegacySatellite> satellites;
    bool divergence_free = false;  ///< ranges are smoothed free of the ionosphere's divergence (DF007, DF036)
    int smoothing_interval = 0;    ///< DF008, DF037: 0 is none
};

/// True for the numbers 1001 to 1004 and 1009 to 1012.
bool is_legacy_observables(int number);
/// Whole light milliseconds of a pseudorange are told (DF014, DF044), and C/N0: 1002, 1004, 1010 and 1012. The others
/// tell ranges and phases modulo legacy_range_modulus_m().
bool is_extended_legacy(int number);
/// 299 792.458 m of GPS and 599 584.916 m of GLONASS (DF011, DF041).
double legacy_range_modulus_m(int number);

/// The frame. A range on L1 needs a phase beside it: without one its field serves L2 alone (DF012). Phases further from
/// their range than the field reaches are told multiples of 1500 cycles nearer (DF012, DF018). Satellites without a
/// range on L1, or one beyond 76.7e6 m, are left out, and those after the 31st; so are ranges on L2 that are further
/// than 163.8 m from those on L1. Empty for other numbers and for no satellites at all.
Bytes encode(const Rtcm3LegacyObservables& observables);
/// Wavelengths are not transmitted. Lock times are the least that the indicators allow (table 3.4-2). Nothing for other
/// numbers and cut messages.
std::optional<Rtcm3LegacyObservables> decode_legacy(const Rtcm3Message& message);

}  // namespace skyloop::inline receiver
