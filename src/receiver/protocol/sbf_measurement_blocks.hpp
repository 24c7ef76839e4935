/// SBF blocks of measurements.
///
/// Layouts: Septentrio PolaRx5TR reference guide (firmware 5.5), section 4.2.1.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "receiver/protocol/sbf_blocks.hpp"

namespace skyloop {

/// A further signal of a satellite (MeasEpochChannelType2): differences from the first one, in two parts each. The
/// lowest numbers of the upper parts, with lower parts of 0, stand for nothing.
struct SbfOtherSignal {
    std::uint8_t type = 0;         ///< bits: 0-4 signal (31: see obs_info), 5-7 antenna
    std::uint8_t lock_time = 255;  ///< s
    std::uint8_t cn0 = 255;        ///< 0.25 dB-Hz above 10
    /// Bits: 0-2 of the range, 65.536 m; 3-7 of the Doppler, 6.5536 Hz; both with a sign.
    std::uint8_t offsets_msb = 0b10000'100;
    std::int8_t carrier_msb = -128;        ///< 65.536 cycles
    std::uint8_t obs_info = 0;             ///< as of the first signal
    std::uint16_t code_offset_lsb = 0;     ///< 0.001 m, beyond the first signal's range
    std::uint16_t carrier_lsb = 0;         ///< 0.001 cycles, beyond this signal's range
    std::uint16_t doppler_offset_lsb = 0;  ///< 0.0001 Hz, beyond the first signal's in this signal's cycles
};

/// A satellite with its first signal (MeasEpochChannelType1).
struct SbfMeasuredSatellite {
    std::uint8_t rx_channel = 0;
    std::uint8_t type = 0;  ///< bits: 0-4 signal (31: see obs_info), 5-7 antenna
    std::uint8_t svid = 0;
    std::uint8_t misc = 0;               ///< bits 0-3: of the range, 4294967.296 m
    std::uint32_t code_lsb = 0;          ///< 0.001 m; 0 of both: nothing
    std::int32_t doppler = -2147483648;  ///< 0.0001 Hz, positive when it comes nearer
    std::uint16_t carrier_lsb = 0;       ///< 0.001 cycles beyond the range; with the lowest upper part: nothing
    std::int8_t carrier_msb = -128;      ///< 65.536 cycles
    std::uint8_t cn0 = 255;              ///< 0.25 dB-Hz above 10
    std::uint16_t lock_time = 0xFFFF;    ///< s
    std::uint8_t obs_info = 0;  ///< bits: 0 smoothed, 2 half a cycle unknown, 3-7 GLONASS channel + 8, or signal − 32
    std::vector<SbfOtherSignal> others;

    template <class M, class V>
    static void fields(M& m, V& v) {
        v(m.rx_channel, m.type, m.svid, m.misc, m.code_lsb, m.doppler, m.carrier_lsb, m.carrier_msb, m.cn0, m.lock_time,
          m.obs_info);
        v.count(m.others);
        v.items(m.others);
    }
};

/// MeasEpoch, version 2: everything that was measured at one instant of the receiver's clock.
struct SbfMeasEpoch {
    static constexpr std::uint16_t block_number = 4027;
    static constexpr std::uint8_t block_revision = 1;
    static constexpr std::string_view message_name = "MeasEpoch";
    static constexpr std::string_view field_names =
        "tow_s*1e-3!4294967295 week!65535 -satellite_bytes -signal_bytes common_flags clock_jumps_s*1e-3 -reserved "
        "satellites[rx_channel type svid code_msb code_lsb_m*1e-3 doppler_hz*1e-4!-2147483648 carrier_lsb*1e-3 "
        "carrier_msb cn0_above_10_dbhz*25e-2!255 lock_time_s!65535 obs_info others[type lock_time_s!255 "
        "cn0_above_10_dbhz*25e-2!255 offsets_msb carrier_msb obs_info code_offset_lsb_m*1e-3 carrier_lsb*1e-3 "
        "doppler_offset_lsb_hz*1e-4]]";
    static constexpr std::uint8_t satellite_bytes = 20, signal_bytes = 12;
    SbfTime time;
    std::uint8_t sb1_length = satellite_bytes;
    std::uint8_t sb2_length = signal_bytes;
    std::uint8_t common_flags = 0;  ///< bits: 0 multipath mitigated, 1 code smoothed, 3 clock steered
    std::uint8_t clock_jumps = 0;   ///< ms since the start, modulo 256
    std::uint8_t reserved = 0;
    std::vector<SbfMeasuredSatellite> satellites;

    template <class M, class V>
    static void fields(M& m, V& v) {
        v(m.time);
        v.count(m.satellites);
        v(m.sb1_length, m.sb2_length, m.common_flags, m.clock_jumps, m.reserved);
        v.items(m.satellites);
    }
};

/// How well one signal was measured.
struct SbfSignalExtra {
    std::uint8_t rx_channel = 0;
    std::uint8_t type = 0;                    ///< as of MeasEpoch
    std::int16_t multipath_correction = 0;    ///< 0.001 m, taken off the range
    std::int16_t smoothing_correction = 0;    ///< 0.001 m, taken off the range
    std::uint16_t code_variance = 0xFFFF;     ///< 1e-4 m²
    std::uint16_t carrier_variance = 0xFFFF;  ///< 1e-6 cycles²
    std::uint16_t lock_time = 0xFFFF;         ///< s
    std::uint8_t losses = 0;                  ///< of the phase's continuity since the start, modulo 256
    std::int8_t carrier_multipath = 0;        ///< 1/512 cycles
    std::uint8_t info = 0;
    std::uint8_t misc = 0;  ///< bits: 0-2 of C/N0, 0.03125 dB-Hz; 3-7 signal − 32
};

/// MeasExtra: what MeasEpoch leaves out. Blocks of longer parts are not read.
struct SbfMeasExtra {
    static constexpr std::uint16_t block_number = 4000;
    static constexpr std::uint8_t block_revision = 3;
    static constexpr std::string_view message_name = "MeasExtra";
    static constexpr std::string_view field_names =
        "tow_s*1e-3!4294967295 week!65535 -signal_bytes doppler_var_factor signals[rx_channel type "
        "multipath_correction_m*1e-3 smoothing_correction_m*1e-3 code_variance_m2*1e-4!65535 "
        "carrier_variance_cycles2*1e-6!65535 lock_time_s!65535 losses carrier_multipath_cycles*2^-9 -info misc]";
    static constexpr std::uint8_t part_bytes = 16;
    SbfTime time;
    std::uint8_t sb_length = part_bytes;
    float doppler_var_factor = 0;  ///< the Doppler's variance over the carrier's, mHz²/mcycles²
    std::vector<SbfSignalExtra> signals;

    template <class M, class V>
    static void fields(M& m, V& v) {
        v(m.time);
        v.count(m.signals);
        v(m.sb_length, m.doppler_var_factor);
        v.items(m.signals);
    }
};

/// EndOfMeas: nothing more of an epoch's measurements follows.
struct SbfEndOfMeas {
    static constexpr std::uint16_t block_number = 5922;
    static constexpr std::uint8_t block_revision = 0;
    static constexpr std::string_view message_name = "EndOfMeas";
    static constexpr std::string_view field_names = "tow_s*1e-3!4294967295 week!65535";
    SbfTime time;
};

/// Whether the parts of a MeasEpoch are as long as those known here.
inline bool has_known_parts(const SbfMeasEpoch& message) {
    return message.sb1_length == SbfMeasEpoch::satellite_bytes && message.sb2_length == SbfMeasEpoch::signal_bytes;
}

}  // namespace skyloop
