/// UBX messages of class RXM beside RXM-RAWX and RXM-SFRBX.
///
/// Numbers are as on the wire; a member's comment gives unit and scale. Each message names where its layout stands: a
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
    std::uint8_t gnss_id = 0;  ///< 0 GPS, 1 SBAS, 2 Galileo, 3 BeiDou, 5 QZSS, 6 GLONASS
    std::uint8_t sv_id = 0;
    std::uint8_t cno = 0;          ///< dBHz
    std::uint8_t mpath_indic = 0;  ///< 0 not measured, 1 low, 2 medium, 3 high
    std::int32_t doppler_ms = 0;   ///< 0.04 m/s
    std::int32_t doppler_hz = 0;   ///< 0.2 Hz
    std::uint16_t whole_chips = 0;
    std::uint16_t frac_chips = 0;         ///< 2^-10 chip
    std::uint32_t code_phase = 0;         ///< 2^-21 ms
    std::uint8_t int_code_phase = 0;      ///< ms
    std::uint8_t pseu_range_rms_err = 0;  ///< index 0 to 63
    std::array<std::uint8_t, 2> reserved4{};
};

/// RXM-MEASX: code phases for others to solve (RECEIVER.md 3.2).
struct RxmMeasx {
    static constexpr UbxMessageId message_id{0x02, 0x14};
    std::uint8_t version = 1;  ///< 1
    std::array<std::uint8_t, 3> reserved0{};
    std::uint32_t gps_tow = 0;      ///< ms
    std::uint32_t glo_tow = 0;      ///< ms
    std::uint32_t bds_tow = 0;      ///< ms
    std::uint32_t gal_tow = 0;      ///< ms; not in the manuals, seen of a ZED-F9P (HPG 1.11)
    std::uint32_t qzss_tow = 0;     ///< ms
    std::uint16_t gps_tow_acc = 0;  ///< 2^-4 ms
    std::uint16_t glo_tow_acc = 0;  ///< 2^-4 ms
    std::uint16_t bds_tow_acc = 0;  ///< 2^-4 ms
    std::array<std::uint8_t, 2> reserved2{};
    std::uint16_t qzss_tow_acc = 0;  ///< 2^-4 ms
    std::uint8_t flags = 0;          ///< bits 0-1: 0 no time, 1 time of week, 2 measured with it
    std::array<std::uint8_t, 8> reserved3{};
    std::vector<RxmMeasxItem> satellites;

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
    std::uint8_t version = 2;  ///< 2
    std::uint8_t flags = 0;    ///< bits: 0 CRC failed, 1-2: 0 unknown, 1 not used, 2 used
    std::uint16_t sub_type = 0;
    std::uint16_t ref_station = 0;  ///< DF003, or 0xFFFF
    std::uint16_t msg_type = 0;     ///< 1077
};

/// RXM-COR: a message of corrections came in, of whatever protocol (F9 interface description).
struct RxmCor {
    static constexpr UbxMessageId message_id{0x02, 0x34};
    std::uint8_t version = 1;  ///< 1
    std::uint8_t ebno = 0;     ///< 2^-3 dB, of what came from a satellite; 0 unknown
    std::array<std::uint8_t, 2> reserved0{};
    /// Bits: 0-4 protocol (1 RTCM 3, 2 SPARTN), 5-6: 1 free of errors, 2 erroneous, 7-8: 1 not used, 2 used, 9-24 DF003
    /// of RTCM 3 or 0xFFFF, 25 msg_type is valid, 26 msg_sub_type is, 27 the receiver knows such messages,
    /// 28-29: 1 not encrypted, 2 encrypted, 30-31: 1 not decrypted, 2 decrypted; 0 unknown.
    std::uint32_t status_info = 0;
    std::uint16_t msg_type = 0;      ///< 1077
    std::uint16_t msg_sub_type = 0;  ///< of 4072
};

/// One satellite of RXM-SVSI.
struct RxmSvsiItem {
    std::uint8_t sv_id = 0;    ///< one numbering for all systems
    std::uint8_t sv_flag = 0;  ///< bits: 0-3 accuracy index, 4 healthy, 5 ephemeris, 6 almanac, 7 not available
    std::int16_t azim = 0;     ///< deg
    std::int8_t elev = 0;      ///< deg
    std::uint8_t age = 0;      ///< bits: 0-3 almanac, days + 4; 4-7 ephemeris, hours + 4; 15 none
};

/// RXM-SVSI: what is known of satellites (M8 interface description).
struct RxmSvsi {
    static constexpr UbxMessageId message_id{0x02, 0x20};
    std::uint32_t i_tow = 0;   ///< ms, GPS time of week of the epoch
    std::int16_t week = 0;     ///< GPS week
    std::uint8_t num_vis = 0;  ///< satellites above the horizon
    std::vector<RxmSvsiItem> satellites;

    static void fields(auto& m, auto& v) {
        v(m.i_tow, m.week, m.num_vis);
        v.count(m.satellites);
        v.items(m.satellites);
    }
};

/// RXM-PMREQ, a command: how long the receiver is to be off (M8 and F9 interface descriptions).
struct RxmPmreqShort {
    static constexpr UbxMessageId message_id{0x02, 0x41};
    std::uint32_t duration = 0;  ///< ms; 0: until it is woken
    std::uint32_t flags = 0;     ///< bits: 1 backup, without which it means nothing
};

/// RXM-PMREQ in its longer form.
struct RxmPmreq {
    static constexpr UbxMessageId message_id{0x02, 0x41};
    std::uint8_t version = 0;  ///< 0
    std::array<std::uint8_t, 3> reserved0{};
    std::uint32_t duration = 0;        ///< ms; 0: until it is woken
    std::uint32_t flags = 0;           ///< bits: 1 backup, 2 even while USB is connected
    std::uint32_t wakeup_sources = 0;  ///< bits: 3 UART RX, 5 EXTINT0, 6 EXTINT1, 7 SPI CS
};

/// RXM-RLM: an answer to a distress call, short form (M8 interface description).
struct RxmRlm {
    static constexpr UbxMessageId message_id{0x02, 0x59};
    std::uint8_t version = 0;  ///< 0
    std::uint8_t type = 1;     ///< 1 short
    std::uint8_t sv_id = 0;    ///< of Galileo
    std::uint8_t reserved0 = 0;
    std::array<std::uint8_t, 8> beacon{};  ///< most significant byte first
    std::uint8_t message = 0;
    std::array<std::uint8_t, 2> params{};
    std::uint8_t reserved1 = 0;
};

}  // namespace skyloop::inline receiver
