/// UBX messages of class RXM beside RXM-RAWX and RXM-SFRBX.
///
/// Fields are declared as field.hpp says. Each message names where its layout stands: a
/// section of RECEIVER.md, or the message of that name in the M8 (UBX-13003221), F9 (HPG 1.32, UBX-22008968) or M10
/// (SPG 5.10) interface description.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "receiver/protocol/ubx_fields.hpp"

namespace skyloop::inline receiver {

/// One satellite of RXM-MEASX.
struct RxmMeasxItem {
    U1<"gnss_id"> gnss_id{};  ///< 0 GPS, 1 SBAS, 2 Galileo, 3 BeiDou, 5 QZSS, 6 GLONASS
    U1<"sv_id"> sv_id{};
    U1<"cno_dbhz"> cno{};
    U1<"multipath"> mpath_indic{};  ///< 0 not measured, 1 low, 2 medium, 3 high
    I4<"doppler_mps*4e-2"> doppler_ms{};
    I4<"doppler_hz*2e-1"> doppler_hz{};
    U2<"whole_chips"> whole_chips{};
    U2<"fraction_chips*2^-10"> frac_chips{};
    U4<"code_phase_ms*2^-21"> code_phase{};
    U1<"whole_code_phase_ms"> int_code_phase{};
    U1<"range_deviation_code"> pseu_range_rms_err{};  ///< index 0 to 63
    std::array<std::uint8_t, 2> reserved4{};
};

/// RXM-MEASX: code phases for others to solve (RECEIVER.md 3.2).
struct RxmMeasx {
    static constexpr UbxMessageId message_id{0x02, 0x14};
    U1<"version"> version = 1;  ///< 1
    std::array<std::uint8_t, 3> reserved0{};
    U4<"gps_tow_s*1e-3"> gps_tow{};
    U4<"glonass_tow_s*1e-3"> glo_tow{};
    U4<"beidou_tow_s*1e-3"> bds_tow{};
    std::uint32_t gal_tow = 0;  ///< ms; not in the manuals, seen of a ZED-F9P (HPG 1.11)
    U4<"qzss_tow_s*1e-3"> qzss_tow{};
    U2<"gps_tow_acc_ms*2^-4"> gps_tow_acc{};
    U2<"glonass_tow_acc_ms*2^-4"> glo_tow_acc{};
    U2<"beidou_tow_acc_ms*2^-4"> bds_tow_acc{};
    std::array<std::uint8_t, 2> reserved2{};
    U2<"qzss_tow_acc_ms*2^-4"> qzss_tow_acc{};
    U1<"flags"> flags{};  ///< bits 0-1: 0 no time, 1 time of week, 2 measured with it
    std::array<std::uint8_t, 8> reserved3{};
    List<"satellites", RxmMeasxItem> satellites;

    static void fields(auto& m, auto& v) {
        v(m.version, m.reserved0, m.gps_tow, m.glo_tow, m.bds_tow, m.gal_tow, m.qzss_tow, m.gps_tow_acc, m.glo_tow_acc,
          m.bds_tow_acc, m.reserved2, m.qzss_tow_acc);
        v.count(m.satellites);
        v(m.flags, m.reserved3);
        v.items(m.satellites);
    }
};

/// RXM-RTCM: one RTCM message came in (RECEIVER.md 3.2).
struct RxmRtcm {
    static constexpr UbxMessageId message_id{0x02, 0x32};
    U1<"version"> version = 2;  ///< 2
    U1<"flags"> flags{};        ///< bits: 0 CRC failed, 1-2: 0 unknown, 1 not used, 2 used
    U2<"subtype"> sub_type{};
    U2<"station"> ref_station{};  ///< DF003, or 0xFFFF
    U2<"message"> msg_type{};     ///< 1077
};

/// RXM-COR: a message of corrections came in, of whatever protocol (F9 interface description).
struct RxmCor {
    static constexpr UbxMessageId message_id{0x02, 0x34};
    U1<"version"> version = 1;  ///< 1
    U1<"ebno_db*2^-3"> ebno{};  ///< of what came from a satellite; 0 unknown
    std::array<std::uint8_t, 2> reserved0{};
    /// Bits: 0-4 protocol (1 RTCM 3, 2 SPARTN), 5-6: 1 free of errors, 2 erroneous, 7-8: 1 not used, 2 used, 9-24 DF003
    /// of RTCM 3 or 0xFFFF, 25 msg_type is valid, 26 msg_sub_type is, 27 the receiver knows such messages,
    /// 28-29: 1 not encrypted, 2 encrypted, 30-31: 1 not decrypted, 2 decrypted; 0 unknown.
    U4<"status"> status_info{};
    U2<"message"> msg_type{};      ///< 1077
    U2<"subtype"> msg_sub_type{};  ///< of 4072
};

/// One satellite of RXM-SVSI.
struct RxmSvsiItem {
    U1<"sv_id"> sv_id{};    ///< one numbering for all systems
    U1<"flags"> sv_flag{};  ///< bits: 0-3 accuracy index, 4 healthy, 5 ephemeris, 6 almanac, 7 not available
    I2<"azimuth_deg"> azim{};
    I1<"elevation_deg"> elev{};
    U1<"age"> age{};  ///< bits: 0-3 almanac, days + 4; 4-7 ephemeris, hours + 4; 15 none
};

/// RXM-SVSI: what is known of satellites (M8 interface description).
struct RxmSvsi {
    static constexpr UbxMessageId message_id{0x02, 0x20};
    U4<"tow_s*1e-3"> i_tow{};  ///< GPS time of week of the epoch
    I2<"week"> week{};         ///< GPS week
    U1<"visible"> num_vis{};   ///< satellites above the horizon
    List<"satellites", RxmSvsiItem> satellites;

    static void fields(auto& m, auto& v) {
        v(m.i_tow, m.week, m.num_vis);
        v.count(m.satellites);
        v.items(m.satellites);
    }
};

/// RXM-PMREQ, a command: how long the receiver is to be off (M8 and F9 interface descriptions).
struct RxmPmreqShort {
    static constexpr UbxMessageId message_id{0x02, 0x41};
    U4<"duration_s*1e-3"> duration{};  ///< 0: until it is woken
    U4<"flags"> flags{};               ///< bits: 1 backup, without which it means nothing
};

/// RXM-PMREQ in its longer form.
struct RxmPmreq {
    static constexpr UbxMessageId message_id{0x02, 0x41};
    U1<"version"> version{};  ///< 0
    std::array<std::uint8_t, 3> reserved0{};
    U4<"duration_s*1e-3"> duration{};       ///< 0: until it is woken
    U4<"flags"> flags{};                    ///< bits: 1 backup, 2 even while USB is connected
    U4<"wakeup_sources"> wakeup_sources{};  ///< bits: 3 UART RX, 5 EXTINT0, 6 EXTINT1, 7 SPI CS
};

/// RXM-RLM: an answer to a distress call, short form (M8 interface description).
struct RxmRlm {
    static constexpr UbxMessageId message_id{0x02, 0x59};
    U1<"version"> version{};  ///< 0
    U1<"type"> type = 1;      ///< 1 short
    U1<"sv_id"> sv_id{};      ///< of Galileo
    std::uint8_t reserved0 = 0;
    U1<"beacon", 8> beacon{};  ///< most significant byte first
    U1<"message"> message{};
    U1<"parameters", 2> params{};
    std::uint8_t reserved1 = 0;
};

}  // namespace skyloop::inline receiver
