/// UBX messages that list satellites and signals: NAV-SAT, NAV-SVINFO, NAV-SIG, RXM-RAWX and RXM-SFRBX.
///
/// Numbers are as on the wire; a member's comment gives unit and scale. Sections are those of the u-blox M8 interface
/// description (UBX-13003221) and, where named, of the F9 one (HPG 1.32, UBX-22008968).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "receiver/protocol/ubx_fields.hpp"

namespace skyloop::inline receiver {

/// One satellite of NAV-SAT.
struct NavSatItem {
    std::uint8_t gnss_id = 0;  ///< 0 GPS, 1 SBAS, 2 Galileo, 3 BeiDou, 5 QZSS, 6 GLONASS
    std::uint8_t sv_id = 0;
    std::uint8_t cno = 0;     ///< dBHz
    std::int8_t elev = 0;     ///< deg, -91 unknown
    std::int16_t azim = 0;    ///< deg
    std::int16_t pr_res = 0;  ///< 0.1 m
    std::uint32_t flags = 0;  ///< bits: 0-2 quality, 3 used, 4-5 health, 8-10 orbit source, 11 ephemeris, 12 almanac
};

/// NAV-SAT: all satellites.
struct NavSat {
    static constexpr UbxMessageId message_id{0x01, 0x35};
    std::uint32_t i_tow = 0;   ///< ms, GPS time of week of the epoch
    std::uint8_t version = 0;  ///< 1
    std::array<std::uint8_t, 2> reserved{};
    std::vector<NavSatItem> satellites;

    static void fields(auto& m, auto& v) {
        v(m.i_tow, m.version);
        v.count(m.satellites);
        v(m.reserved);
        v.items(m.satellites);
    }
};

/// One channel of NAV-SVINFO.
struct NavSvinfoItem {
    std::uint8_t chn = 0;      ///< 255 none
    std::uint8_t sv_id = 0;    ///< one numbering for all systems
    std::uint8_t flags = 0;    ///< bits: 0 used, 1 differential, 2 orbit, 3 ephemeris, 4 unhealthy
    std::uint8_t quality = 0;  ///< bits 0-3
    std::uint8_t cno = 0;      ///< dBHz
    std::int8_t elev = 0;      ///< deg
    std::int16_t azim = 0;     ///< deg
    std::int32_t pr_res = 0;   ///< cm
};

/// NAV-SVINFO: all channels (M8 and older).
struct NavSvinfo {
    static constexpr UbxMessageId message_id{0x01, 0x30};
    std::uint32_t i_tow = 0;        ///< ms, GPS time of week of the epoch
    std::uint8_t global_flags = 0;  ///< bits 0-2: generation
    std::array<std::uint8_t, 2> reserved{};
    std::vector<NavSvinfoItem> channels;

    static void fields(auto& m, auto& v) {
        v(m.i_tow);
        v.count(m.channels);
        v(m.global_flags, m.reserved);
        v.items(m.channels);
    }
};

/// One signal of NAV-SIG.
struct NavSigItem {
    std::uint8_t gnss_id = 0;  ///< 0 GPS, 1 SBAS, 2 Galileo, 3 BeiDou, 5 QZSS, 6 GLONASS
    std::uint8_t sv_id = 0;
    std::uint8_t sig_id = 0;
    std::uint8_t freq_id = 0;  ///< GLONASS channel + 7
    std::int16_t pr_res = 0;   ///< 0.1 m
    std::uint8_t cno = 0;      ///< dBHz
    std::uint8_t quality = 0;  ///< 0 to 7
    std::uint8_t corr_source = 0;
    std::uint8_t iono_model = 0;
    std::uint16_t flags = 0;  ///< bits: 0-1 health, 2 smoothed, 3-5 range, carrier, Doppler used
    std::array<std::uint8_t, 4> reserved{};
};

/// NAV-SIG: all signals (F9 interface description).
struct NavSig {
    static constexpr UbxMessageId message_id{0x01, 0x43};
    std::uint32_t i_tow = 0;   ///< ms, GPS time of week of the epoch
    std::uint8_t version = 0;  ///< 0
    std::array<std::uint8_t, 2> reserved{};
    std::vector<NavSigItem> signals;

    static void fields(auto& m, auto& v) {
        v(m.i_tow, m.version);
        v.count(m.signals);
        v(m.reserved);
        v.items(m.signals);
    }
};

/// One measurement of RXM-RAWX.
struct RxmRawxItem {
    double pr_mes = 0;         ///< m
    double cp_mes = 0;         ///< cycles
    float do_mes = 0;          ///< Hz
    std::uint8_t gnss_id = 0;  ///< 0 GPS, 1 SBAS, 2 Galileo, 3 BeiDou, 5 QZSS, 6 GLONASS
    std::uint8_t sv_id = 0;
    std::uint8_t sig_id = 0;
    std::uint8_t freq_id = 0;    ///< GLONASS channel + 7
    std::uint16_t locktime = 0;  ///< ms, at most 64500
    std::uint8_t cno = 0;        ///< dBHz
    std::uint8_t pr_stdev = 0;   ///< bits 0-3: 0.01·2^n m
    std::uint8_t cp_stdev = 0;   ///< bits 0-3: 0.004·n cycles, 15 invalid
    std::uint8_t do_stdev = 0;   ///< bits 0-3: 0.002·2^n Hz
    std::uint8_t trk_stat = 0;   ///< bits: 0 range, 1 phase, 2 half cycle, 3 half cycle subtracted
    std::uint8_t reserved = 0;
};

/// RXM-RAWX: raw measurements.
struct RxmRawx {
    static constexpr UbxMessageId message_id{0x02, 0x15};
    double rcv_tow = 0;         ///< s, receiver time
    std::uint16_t week = 0;     ///< GPS week
    std::int8_t leap_s = 0;     ///< s
    std::uint8_t rec_stat = 0;  ///< bits: 0 leap seconds known, 1 clock reset
    std::uint8_t version = 0;   ///< 1
    std::array<std::uint8_t, 2> reserved{};
    std::vector<RxmRawxItem> measurements;

    static void fields(auto& m, auto& v) {
        v(m.rcv_tow, m.week, m.leap_s);
        v.count(m.measurements);
        v(m.rec_stat, m.version, m.reserved);
        v.items(m.measurements);
    }
};

/// RXM-SFRBX: one broadcast subframe.
struct RxmSfrbx {
    static constexpr UbxMessageId message_id{0x02, 0x13};
    std::uint8_t gnss_id = 0;  ///< 0 GPS, 1 SBAS, 2 Galileo, 3 BeiDou, 5 QZSS, 6 GLONASS
    std::uint8_t sv_id = 0;
    std::uint8_t sig_id = 0;   ///< reserved on M8
    std::uint8_t freq_id = 0;  ///< GLONASS channel + 7
    std::uint8_t chn = 0;
    std::uint8_t version = 0;  ///< 2
    std::uint8_t reserved = 0;
    std::vector<std::uint32_t> words;  ///< as received

    static void fields(auto& m, auto& v) {
        v(m.gnss_id, m.sv_id, m.sig_id, m.freq_id);
        v.count(m.words);
        v(m.chn, m.version, m.reserved);
        v.items(m.words);
    }
};

}  // namespace skyloop::inline receiver
