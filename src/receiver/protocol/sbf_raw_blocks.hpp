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
    U1<"type"> type{};  ///< bits: 0-4 signal (31: see obs_info), 5-7 antenna
    U1<"lock_time_s!255"> lock_time = 255;
    U1<"cn0_above_10_dbhz*2^-2!255"> cn0 = 255;  ///< above 10
    /// Bits: 0-2 of the range, 65.536 m; 3-7 of the Doppler, 6.5536 Hz; both with a sign.
    U1<"offsets_msb"> offsets_msb = 0b10000'100;
    I1<"carrier_msb"> carrier_msb = -128;                   ///< 65.536 cycles
    U1<"obs_info"> obs_info{};                              ///< as of the first signal
    U2<"code_offset_lsb_m*1e-3"> code_offset_lsb{};         ///< beyond the first signal's range
    U2<"carrier_lsb*1e-3"> carrier_lsb{};                   ///< 0.001 cycles, beyond this signal's range
    U2<"doppler_offset_lsb_hz*1e-4"> doppler_offset_lsb{};  ///< beyond the first signal's in this signal's cycles
};

/// A satellite with its first signal (MeasEpochChannelType1).
struct SbfMeasuredSatellite {
    U1<"rx_channel"> rx_channel{};
    U1<"type"> type{};  ///< bits: 0-4 signal (31: see obs_info), 5-7 antenna
    U1<"svid"> svid{};
    U1<"code_msb"> misc{};                                    ///< bits 0-3: of the range, 4294967.296 m
    U4<"code_lsb_m*1e-3"> code_lsb{};                         ///< 0 of both: nothing
    I4<"doppler_hz*1e-4!-2147483648"> doppler = -2147483648;  ///< positive when it comes nearer
    U2<"carrier_lsb*1e-3"> carrier_lsb{};        ///< 0.001 cycles beyond the range; with the lowest upper part: nothing
    I1<"carrier_msb"> carrier_msb = -128;        ///< 65.536 cycles
    U1<"cn0_above_10_dbhz*2^-2!255"> cn0 = 255;  ///< above 10
    U2<"lock_time_s!65535"> lock_time = 0xFFFF;
    U1<"obs_info"> obs_info{};  ///< bits: 0 smoothed, 2 half a cycle unknown, 3-7 GLONASS channel + 8, or signal − 32
    List<"others", SbfOtherSignal> others;

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
    static constexpr std::uint8_t satellite_bytes = 20, signal_bytes = 12;
    SbfTime time;
    std::uint8_t sb1_length = satellite_bytes;
    std::uint8_t sb2_length = signal_bytes;
    U1<"common_flags"> common_flags{};       ///< bits: 0 multipath mitigated, 1 code smoothed, 3 clock steered
    U1<"clock_jumps_s*1e-3"> clock_jumps{};  ///< since the start, modulo 256
    std::uint8_t reserved = 0;
    List<"satellites", SbfMeasuredSatellite> satellites;

    static void fields(auto& m, auto& v) {
        v(m.time);
        v.count(m.satellites);
        v(m.sb1_length, m.sb2_length, m.common_flags, m.clock_jumps, m.reserved);
        v.items(m.satellites);
    }
};

/// How well one signal was measured.
struct SbfSignalExtra {
    U1<"rx_channel"> rx_channel{};
    U1<"type"> type{};                                         ///< as of MeasEpoch
    I2<"multipath_correction_m*1e-3"> multipath_correction{};  ///< taken off the range
    I2<"smoothing_correction_m*1e-3"> smoothing_correction{};  ///< taken off the range
    U2<"code_variance_m2*1e-4!65535"> code_variance = 0xFFFF;
    U2<"carrier_variance_cycles2*1e-6!65535"> carrier_variance = 0xFFFF;
    U2<"lock_time_s!65535"> lock_time = 0xFFFF;
    U1<"losses"> losses{};  ///< of the phase's continuity since the start, modulo 256
    I1<"carrier_multipath_cycles*2^-9"> carrier_multipath{};
    std::uint8_t info = 0;
    U1<"misc"> misc{};  ///< bits: 0-2 of C/N0, 0.03125 dB-Hz; 3-7 signal − 32
};

/// MeasExtra: what MeasEpoch leaves out. Blocks of longer parts are not read.
struct SbfMeasExtra {
    static constexpr std::uint16_t block_number = 4000;
    static constexpr std::uint8_t block_revision = 3;
    static constexpr std::string_view message_name = "MeasExtra";
    static constexpr std::uint8_t part_bytes = 16;
    SbfTime time;
    std::uint8_t sb_length = part_bytes;
    R4<"doppler_var_factor"> doppler_var_factor{};  ///< the Doppler's variance over the carrier's, mHz²/mcycles²
    List<"signals", SbfSignalExtra> signals;

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
        case 4018:
            return "GPSRawL2C";
        case 4019:
            return "GPSRawL5";
        case 4020:
            return "GEORawL1";
        case 4022:
            return "GALRawFNAV";
        case 4023:
            return "GALRawINAV";
        case 4026:
            return "GLORawCA";
        case 4047:
            return "BDSRaw";
        case 4066:
            return "QZSRawL1CA";
        case 4067:
            return "QZSRawL2C";
        case 4068:
            return "QZSRawL5";
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
    SbfTime time;
    U1<"svid"> svid{};
    U1<"crc_passed"> crc_passed = 1;
    U1<"viterbi_count"> viterbi_count{};  ///< errors that the Viterbi decoder corrected
    U1<"source"> source{};                ///< bits: 0-4 signal, 5 the halves of an I/NAV page came by different ones
    U1<"freq_nr"> freq_nr{};              ///< of GLONASS: channel + 8
    U1<"rx_channel"> rx_channel{};
    U4<"words", Words> words{};
};
using SbfGpsRawCa = SbfRawPage<4017, 10>;
/// An even and an odd page of I/NAV: 114 bits, without the tail, and 120.
using SbfGalRawInav = SbfRawPage<4023, 8>;
/// A message of 250 bits.
using SbfGeoRawL1 = SbfRawPage<4020, 8>;
using SbfGloRawCa = SbfRawPage<4026, 3>;
using SbfBdsRaw = SbfRawPage<4047, 10>;
using SbfQzsRawL1Ca = SbfRawPage<4066, 10>;
/// The 300 bits of a CNAV message.
using SbfGpsRawL2c = SbfRawPage<4018, 10>;
using SbfGpsRawL5 = SbfRawPage<4019, 10>;
using SbfQzsRawL2c = SbfRawPage<4067, 10>;
using SbfQzsRawL5 = SbfRawPage<4068, 10>;
/// The 244 bits of a page of F/NAV.
using SbfGalRawFnav = SbfRawPage<4022, 8>;

/// The orbit as GPSNav, QZSNav and BDSNav have it.
struct SbfKeplerOrbit {
    R4<"c_rs_m"> c_rs{};
    R4<"delta_n"> delta_n{};  ///< semicircles/s
    R8<"m_0"> m_0{};
    R4<"c_uc_rad"> c_uc{};
    R8<"e"> e{};
    R4<"c_us_rad"> c_us{};
    R8<"sqrt_a"> sqrt_a{};  ///< √m
    U4<"toe_s"> toe{};
    R4<"c_ic_rad"> c_ic{};
    R8<"omega_0"> omega_0{};
    R4<"c_is_rad"> c_is{};
    R8<"i_0"> i_0{};
    R4<"c_rc_m"> c_rc{};
    R8<"omega"> omega{};
    R4<"omega_dot"> omega_dot{};  ///< semicircles/s
    R4<"idot"> idot{};            ///< semicircles/s
};

/// GPSNav and QZSNav: the record of subframes 1 to 3. Weeks are modulo 1024.
template <std::uint16_t Number>
struct SbfLnavRecord {
    static constexpr std::uint16_t block_number = Number;
    static constexpr std::uint8_t block_revision = 0;
    static constexpr std::string_view message_name = Number == 5891 ? "GPSNav" : "QZSNav";
    SbfTime time;
    U1<"svid"> svid{};
    std::uint8_t reserved = 0;
    U2<"record_week!65535"> week{};
    U1<"code_on_l2"> code_on_l2{};
    U1<"ura"> ura{};  ///< index
    U1<"health"> health{};
    U1<"l2_data_flag"> l2_data_flag{};
    U2<"iodc"> iodc{};
    U1<"iode2"> iode2{};  ///< of subframe 2 and of subframe 3
    U1<"iode3"> iode3{};
    U1<"fit_interval_flag"> fit_interval_flag{};
    std::uint8_t reserved2 = 0;
    R4<"tgd_s"> tgd{};
    U4<"toc_s"> toc{};
    R4<"af2"> af2{};
    R4<"af1"> af1{};
    R4<"af0_s"> af0{};
    SbfKeplerOrbit orbit;
    U2<"toc_week"> toc_week{};
    U2<"toe_week"> toe_week{};
};
using SbfGpsNav = SbfLnavRecord<5891>;
using SbfQzsNav = SbfLnavRecord<4095>;

/// BDSNav: the record of D1 or D2. Weeks and times are BeiDou's.
struct SbfBdsNav {
    static constexpr std::uint16_t block_number = 4081;
    static constexpr std::uint8_t block_revision = 0;
    static constexpr std::string_view message_name = "BDSNav";
    SbfTime time;
    U1<"svid"> svid{};
    std::uint8_t reserved = 0;
    U2<"record_week"> week{};  ///< 0 … 8191
    U1<"ura"> ura{};           ///< index
    U1<"health"> health{};
    U1<"aodc"> aodc{};
    U1<"aode"> aode{};
    std::uint16_t reserved2 = 0;
    R4<"tgd1_s"> tgd1{};
    R4<"tgd2_s!-2e10"> tgd2 = sbf_nothing;
    U4<"toc_s"> toc{};
    R4<"af2"> af2{};
    R4<"af1"> af1{};
    R4<"af0_s"> af0{};
    SbfKeplerOrbit orbit;
    U2<"toc_week"> toc_week{};
    U2<"toe_week"> toe_week{};
};

/// GALNav: the record of I/NAV or F/NAV. Weeks are GPS ones, modulo 4096.
struct SbfGalNav {
    static constexpr std::uint16_t block_number = 4002;
    static constexpr std::uint8_t block_revision = 0;
    static constexpr std::string_view message_name = "GALNav";
    SbfTime time;
    U1<"svid"> svid{};
    U1<"source"> source = 2;  ///< 2 I/NAV, 16 F/NAV: whose clock it is
    SbfKeplerOrbit orbit;     ///< in an order of its own
    U4<"toc_s"> toc{};
    R4<"af2"> af2{};
    R4<"af1"> af1{};
    R8<"af0_s"> af0{};
    U2<"toe_week"> toe_week{};
    U2<"toc_week"> toc_week{};
    U2<"iod_nav"> iod_nav{};
    U2<"health"> health{};  ///< four bits of each of L1-B, E5b, E5a: valid, data validity status, 2 health status
    std::uint8_t health_prs = 0;
    U1<"sisa_l1_e5a!255"> sisa_l1_e5a = 255;  ///< indices
    U1<"sisa_l1_e5b!255"> sisa_l1_e5b = 255;
    std::uint8_t sisa_l1a_e6a = 255;
    R4<"bgd_l1_e5a_s!-2e10"> bgd_l1_e5a = sbf_nothing;
    R4<"bgd_l1_e5b_s!-2e10"> bgd_l1_e5b = sbf_nothing;
    float bgd_l1a_e6a = sbf_nothing;
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
    SbfTime time;
    U1<"svid"> svid{};
    U1<"freq_nr"> freq_nr{};          ///< channel + 8
    R8<"position_km", 3> position{};  ///< PZ-90
    R4<"velocity_kmps", 3> velocity{};
    R4<"acceleration_kmps2", 3> acceleration{};
    R4<"gamma"> gamma{};
    R4<"tau_s"> tau{};          ///< what is to be added to the satellite's time
    R4<"dtau_s"> dtau{};        ///< of L2 against L1
    U4<"toe_s"> toe{};          ///< GPS time of week
    U2<"toe_week"> toe_week{};  ///< GPS week modulo 1024
    U1<"p1_min"> p1 = 30;       ///< between neighbouring t_b
    U1<"p2"> p2{};
    U1<"age_days"> age{};
    U1<"health"> health{};  ///< B_n, 3 bits; the highest: unhealthy
    U2<"tb_min"> tb{};      ///< of the Moscow day
    U1<"m"> m = 1;
    U1<"p"> p{};
    U1<"l"> l{};
    U1<"p4"> p4{};
    U2<"day"> day{};                   ///< N_T, within four years
    U2<"accuracy_m*1e-2"> accuracy{};  ///< F_T
    std::uint8_t c = 0;
};

}  // namespace skyloop::inline receiver
