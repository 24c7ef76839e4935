/// UBX messages that list satellites and signals: NAV-SAT, NAV-SVINFO, NAV-SIG, RXM-RAWX and RXM-SFRBX.
///
/// Fields are declared as field.hpp says. Sections are those of the u-blox M8 interface
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
    U1<"gnss_id"> gnss_id{};  ///< 0 GPS, 1 SBAS, 2 Galileo, 3 BeiDou, 5 QZSS, 6 GLONASS
    U1<"sv_id"> sv_id{};
    U1<"cno_dbhz"> cno{};
    I1<"elevation_deg!-91"> elev{};  ///< -91 unknown
    I2<"azimuth_deg"> azim{};
    I2<"residual_m*1e-1"> pr_res{};
    U4<"flags"> flags{};  ///< bits: 0-2 quality, 3 used, 4-5 health, 8-10 orbit source, 11 ephemeris, 12 almanac
};

/// NAV-SAT: all satellites.
struct NavSat {
    static constexpr UbxMessageId message_id{0x01, 0x35};
    U4<"tow_s*1e-3"> i_tow{};  ///< GPS time of week of the epoch
    U1<"version"> version{};   ///< 1
    std::array<std::uint8_t, 2> reserved{};
    List<"satellites", NavSatItem> satellites;

    static void fields(auto& m, auto& v) {
        v(m.i_tow, m.version);
        v.count(m.satellites);
        v(m.reserved);
        v.items(m.satellites);
    }
};

/// One channel of NAV-SVINFO.
struct NavSvinfoItem {
    U1<"channel!255"> chn{};  ///< 255 none
    U1<"sv_id"> sv_id{};      ///< one numbering for all systems
    U1<"flags"> flags{};      ///< bits: 0 used, 1 differential, 2 orbit, 3 ephemeris, 4 unhealthy
    U1<"quality"> quality{};  ///< bits 0-3
    U1<"cno_dbhz"> cno{};
    I1<"elevation_deg"> elev{};
    I2<"azimuth_deg"> azim{};
    I4<"residual_m*1e-2"> pr_res{};
};

/// NAV-SVINFO: all channels (M8 and older).
struct NavSvinfo {
    static constexpr UbxMessageId message_id{0x01, 0x30};
    U4<"tow_s*1e-3"> i_tow{};           ///< GPS time of week of the epoch
    U1<"global_flags"> global_flags{};  ///< bits 0-2: generation
    std::array<std::uint8_t, 2> reserved{};
    List<"channels", NavSvinfoItem> channels;

    static void fields(auto& m, auto& v) {
        v(m.i_tow);
        v.count(m.channels);
        v(m.global_flags, m.reserved);
        v.items(m.channels);
    }
};

/// One signal of NAV-SIG.
struct NavSigItem {
    U1<"gnss_id"> gnss_id{};  ///< 0 GPS, 1 SBAS, 2 Galileo, 3 BeiDou, 5 QZSS, 6 GLONASS
    U1<"sv_id"> sv_id{};
    U1<"sig_id"> sig_id{};
    U1<"freq_id"> freq_id{};  ///< GLONASS channel + 7
    I2<"residual_m*1e-1"> pr_res{};
    U1<"cno_dbhz"> cno{};
    U1<"quality"> quality{};  ///< 0 to 7
    U1<"correction_source"> corr_source{};
    U1<"ionosphere_model"> iono_model{};
    U2<"flags"> flags{};  ///< bits: 0-1 health, 2 smoothed, 3-5 range, carrier, Doppler used
    std::array<std::uint8_t, 4> reserved{};
};

/// NAV-SIG: all signals (F9 interface description).
struct NavSig {
    static constexpr UbxMessageId message_id{0x01, 0x43};
    U4<"tow_s*1e-3"> i_tow{};  ///< GPS time of week of the epoch
    U1<"version"> version{};   ///< 0
    std::array<std::uint8_t, 2> reserved{};
    List<"signals", NavSigItem> signals;

    static void fields(auto& m, auto& v) {
        v(m.i_tow, m.version);
        v.count(m.signals);
        v(m.reserved);
        v.items(m.signals);
    }
};

/// One measurement of RXM-RAWX.
struct RxmRawxItem {
    R8<"range_m"> pr_mes{};
    R8<"phase_cycles"> cp_mes{};
    R4<"doppler_hz"> do_mes{};
    U1<"gnss_id"> gnss_id{};  ///< 0 GPS, 1 SBAS, 2 Galileo, 3 BeiDou, 5 QZSS, 6 GLONASS
    U1<"sv_id"> sv_id{};
    U1<"sig_id"> sig_id{};
    U1<"freq_id"> freq_id{};            ///< GLONASS channel + 7
    U2<"lock_time_s*1e-3"> locktime{};  ///< at most 64500
    U1<"cno_dbhz"> cno{};
    U1<"range_deviation_code"> pr_stdev{};    ///< bits 0-3: 0.01·2^n m
    U1<"phase_deviation_code"> cp_stdev{};    ///< bits 0-3: 0.004·n cycles, 15 invalid
    U1<"doppler_deviation_code"> do_stdev{};  ///< bits 0-3: 0.002·2^n Hz
    U1<"tracking_status"> trk_stat{};         ///< bits: 0 range, 1 phase, 2 half cycle, 3 half cycle subtracted
    std::uint8_t reserved = 0;
};

/// RXM-RAWX: raw measurements.
struct RxmRawx {
    static constexpr UbxMessageId message_id{0x02, 0x15};
    R8<"tow_s"> rcv_tow{};  ///< receiver time
    U2<"week"> week{};      ///< GPS week
    I1<"leap_seconds"> leap_s{};
    U1<"receiver_status"> rec_stat{};  ///< bits: 0 leap seconds known, 1 clock reset
    U1<"version"> version{};           ///< 1
    std::array<std::uint8_t, 2> reserved{};
    List<"measurements", RxmRawxItem> measurements;

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
    U1<"gnss_id"> gnss_id{};  ///< 0 GPS, 1 SBAS, 2 Galileo, 3 BeiDou, 5 QZSS, 6 GLONASS
    U1<"sv_id"> sv_id{};
    U1<"sig_id"> sig_id{};    ///< reserved on M8
    U1<"freq_id"> freq_id{};  ///< GLONASS channel + 7
    U1<"channel"> chn{};
    U1<"version"> version{};  ///< 2
    std::uint8_t reserved = 0;
    List<"words", std::uint32_t> words;  ///< as received

    static void fields(auto& m, auto& v) {
        v(m.gnss_id, m.sv_id, m.sig_id, m.freq_id);
        v.count(m.words);
        v(m.chn, m.version, m.reserved);
        v.items(m.words);
    }
};

}  // namespace skyloop::inline receiver
