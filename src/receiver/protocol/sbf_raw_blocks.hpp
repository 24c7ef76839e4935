/// SBF blocks of measurements.
///
/// Layouts: Septentrio PolaRx5TR reference guide (firmware 5.5), section 4.2.1.
///
/// SBF blocks of navigation messages: their bits as they were received, and records decoded from them.
///
/// Layouts: Septentrio PolaRx5TR reference guide (firmware 5.5), sections 4.2.2 to 4.2.7. The stamp is the instant at
/// which the satellite had sent the last bit, in GPS time. Angles are semicircles.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "receiver/protocol/sbf_blocks.hpp"

namespace skyloop::inline receiver {

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

    static void fields(auto& m, auto& v) {
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

    static void fields(auto& m, auto& v) {
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

    static void fields(auto& m, auto& v) {
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

/// The name of a block of raw bits.
constexpr std::string_view sbf_page_name(std::uint16_t number) {
    switch (number) {
        case 4017:
            return "GPSRawCA";
        case 4023:
            return "GALRawINAV";
        case 4026:
            return "GLORawCA";
        case 4047:
            return "BDSRaw";
        case 4066:
            return "QZSRawL1CA";
        default:
            return "";
    }
}

/// A subframe, string or page. The first bit received is the highest of the first word, without gaps; of GPSRawCA and
/// QZSRawL1CA each word is one of the subframe: bits 29-6 its data, upright, 5-0 its parity, exclusive or with the last
/// bit of the word before.
template <std::uint16_t Number, std::size_t Words>
struct SbfRawPage {
    static constexpr std::uint16_t block_number = Number;
    static constexpr std::uint8_t block_revision = 0;
    static constexpr std::string_view message_name = sbf_page_name(Number);
    static constexpr std::string_view field_names =
        "tow_s*1e-3!4294967295 week!65535 svid crc_passed viterbi_count source freq_nr rx_channel words";
    SbfTime time;
    std::uint8_t svid = 0;
    std::uint8_t crc_passed = 1;
    std::uint8_t viterbi_count = 0;  ///< errors that the Viterbi decoder corrected
    std::uint8_t source = 0;         ///< bits: 0-4 signal, 5 the halves of an I/NAV page came by different ones
    std::uint8_t freq_nr = 0;        ///< of GLONASS: channel + 8
    std::uint8_t rx_channel = 0;
    std::array<std::uint32_t, Words> words{};
};
using SbfGpsRawCa = SbfRawPage<4017, 10>;
/// An even and an odd page of I/NAV: 114 bits, without the tail, and 120.
using SbfGalRawInav = SbfRawPage<4023, 8>;
using SbfGloRawCa = SbfRawPage<4026, 3>;
using SbfBdsRaw = SbfRawPage<4047, 10>;
using SbfQzsRawL1Ca = SbfRawPage<4066, 10>;

/// The orbit as GPSNav, QZSNav and BDSNav have it.
struct SbfKeplerOrbit {
    float c_rs = 0;     ///< m
    float delta_n = 0;  ///< semicircles/s
    double m_0 = 0;
    float c_uc = 0;  ///< rad
    double e = 0;
    float c_us = 0;         ///< rad
    double sqrt_a = 0;      ///< √m
    std::uint32_t toe = 0;  ///< s
    float c_ic = 0;         ///< rad
    double omega_0 = 0;
    float c_is = 0;  ///< rad
    double i_0 = 0;
    float c_rc = 0;  ///< m
    double omega = 0;
    float omega_dot = 0;  ///< semicircles/s
    float idot = 0;       ///< semicircles/s
};

/// GPSNav and QZSNav: the record of subframes 1 to 3. Weeks are modulo 1024.
template <std::uint16_t Number>
struct SbfLnavRecord {
    static constexpr std::uint16_t block_number = Number;
    static constexpr std::uint8_t block_revision = 0;
    static constexpr std::string_view message_name = Number == 5891 ? "GPSNav" : "QZSNav";
    static constexpr std::string_view field_names =
        "tow_s*1e-3!4294967295 week!65535 svid -reserved record_week!65535 code_on_l2 ura health l2_data_flag iodc "
        "iode2 iode3 fit_interval_flag -reserved tgd_s toc_s af2 af1 af0_s c_rs_m delta_n m_0 c_uc_rad e c_us_rad "
        "sqrt_a toe_s c_ic_rad omega_0 c_is_rad i_0 c_rc_m omega omega_dot idot toc_week toe_week";
    SbfTime time;
    std::uint8_t svid = 0;
    std::uint8_t reserved = 0;
    std::uint16_t week = 0;
    std::uint8_t code_on_l2 = 0;
    std::uint8_t ura = 0;  ///< index
    std::uint8_t health = 0;
    std::uint8_t l2_data_flag = 0;
    std::uint16_t iodc = 0;
    std::uint8_t iode2 = 0, iode3 = 0;  ///< of subframe 2 and of subframe 3
    std::uint8_t fit_interval_flag = 0;
    std::uint8_t reserved2 = 0;
    float tgd = 0;          ///< s
    std::uint32_t toc = 0;  ///< s
    float af2 = 0, af1 = 0, af0 = 0;
    SbfKeplerOrbit orbit;
    std::uint16_t toc_week = 0, toe_week = 0;
};
using SbfGpsNav = SbfLnavRecord<5891>;
using SbfQzsNav = SbfLnavRecord<4095>;

/// BDSNav: the record of D1 or D2. Weeks and times are BeiDou's.
struct SbfBdsNav {
    static constexpr std::uint16_t block_number = 4081;
    static constexpr std::uint8_t block_revision = 0;
    static constexpr std::string_view message_name = "BDSNav";
    static constexpr std::string_view field_names =
        "tow_s*1e-3!4294967295 week!65535 svid -reserved record_week ura health aodc aode -reserved tgd1_s "
        "tgd2_s!-2e10 toc_s af2 af1 af0_s c_rs_m delta_n m_0 c_uc_rad e c_us_rad sqrt_a toe_s c_ic_rad omega_0 "
        "c_is_rad i_0 c_rc_m omega omega_dot idot toc_week toe_week";
    SbfTime time;
    std::uint8_t svid = 0;
    std::uint8_t reserved = 0;
    std::uint16_t week = 0;  ///< 0 … 8191
    std::uint8_t ura = 0;    ///< index
    std::uint8_t health = 0;
    std::uint8_t aodc = 0, aode = 0;
    std::uint16_t reserved2 = 0;
    float tgd1 = 0;                                ///< s
    float tgd2 = static_cast<float>(sbf_nothing);  ///< s
    std::uint32_t toc = 0;                         ///< s
    float af2 = 0, af1 = 0, af0 = 0;
    SbfKeplerOrbit orbit;
    std::uint16_t toc_week = 0, toe_week = 0;
};

/// GALNav: the record of I/NAV or F/NAV. Weeks are GPS ones, modulo 4096.
struct SbfGalNav {
    static constexpr std::uint16_t block_number = 4002;
    static constexpr std::uint8_t block_revision = 0;
    static constexpr std::string_view message_name = "GALNav";
    static constexpr std::string_view field_names =
        "tow_s*1e-3!4294967295 week!65535 svid source sqrt_a m_0 e i_0 omega omega_0 omega_dot idot delta_n c_uc_rad "
        "c_us_rad c_rc_m c_rs_m c_ic_rad c_is_rad toe_s toc_s af2 af1 af0_s toe_week toc_week iod_nav health "
        "-health_prs sisa_l1_e5a!255 sisa_l1_e5b!255 -sisa_l1a_e6a bgd_l1_e5a_s!-2e10 bgd_l1_e5b_s!-2e10 "
        "-bgd_l1a_e6a -cnav_encrypted";
    SbfTime time;
    std::uint8_t svid = 0;
    std::uint8_t source = 2;  ///< 2 I/NAV, 16 F/NAV: whose clock it is
    SbfKeplerOrbit orbit;     ///< in an order of its own
    std::uint32_t toc = 0;    ///< s
    float af2 = 0, af1 = 0;
    double af0 = 0;  ///< s
    std::uint16_t toe_week = 0, toc_week = 0;
    std::uint16_t iod_nav = 0;
    std::uint16_t health = 0;  ///< four bits of each of L1-B, E5b, E5a: valid, data validity status, 2 health status
    std::uint8_t health_prs = 0;
    std::uint8_t sisa_l1_e5a = 255, sisa_l1_e5b = 255, sisa_l1a_e6a = 255;  ///< indices
    float bgd_l1_e5a = static_cast<float>(sbf_nothing);                     ///< s
    float bgd_l1_e5b = static_cast<float>(sbf_nothing);                     ///< s
    float bgd_l1a_e6a = static_cast<float>(sbf_nothing);
    std::uint8_t cnav_encrypted = 255;

    template <class M, class V>
    static void fields(M& m, V& v) {
        auto& o = m.orbit;
        v(m.time, m.svid, m.source, o.sqrt_a, o.m_0, o.e, o.i_0, o.omega, o.omega_0, o.omega_dot, o.idot, o.delta_n,
          o.c_uc, o.c_us, o.c_rc, o.c_rs, o.c_ic, o.c_is, o.toe, m.toc, m.af2, m.af1, m.af0, m.toe_week, m.toc_week,
          m.iod_nav, m.health, m.health_prs, m.sisa_l1_e5a, m.sisa_l1_e5b, m.sisa_l1a_e6a, m.bgd_l1_e5a, m.bgd_l1_e5b,
          m.bgd_l1a_e6a, m.cnav_encrypted);
    }
};

/// GLONav: the state vector of strings 1 to 5.
struct SbfGloNav {
    static constexpr std::uint16_t block_number = 4004;
    static constexpr std::uint8_t block_revision = 0;
    static constexpr std::string_view message_name = "GLONav";
    static constexpr std::string_view field_names =
        "tow_s*1e-3!4294967295 week!65535 svid freq_nr position_km velocity_kmps acceleration_kmps2 gamma tau_s "
        "dtau_s toe_s toe_week p1_min p2 age_days health tb_min m p l p4 day accuracy_m*1e-2 -c";
    SbfTime time;
    std::uint8_t svid = 0;
    std::uint8_t freq_nr = 0;             ///< channel + 8
    std::array<double, 3> position{};     ///< km, PZ-90
    std::array<float, 3> velocity{};      ///< km/s
    std::array<float, 3> acceleration{};  ///< km/s²
    float gamma = 0;
    float tau = 0;               ///< s, what is to be added to the satellite's time
    float dtau = 0;              ///< s, of L2 against L1
    std::uint32_t toe = 0;       ///< s, GPS time of week
    std::uint16_t toe_week = 0;  ///< GPS week modulo 1024
    std::uint8_t p1 = 30;        ///< min between neighbouring t_b
    std::uint8_t p2 = 0;
    std::uint8_t age = 0;     ///< days
    std::uint8_t health = 0;  ///< B_n, 3 bits; the highest: unhealthy
    std::uint16_t tb = 0;     ///< min of the Moscow day
    std::uint8_t m = 1, p = 0, l = 0, p4 = 0;
    std::uint16_t day = 0;       ///< N_T, within four years
    std::uint16_t accuracy = 0;  ///< 0.01 m, F_T
    std::uint8_t c = 0;
};

}  // namespace skyloop::inline receiver
