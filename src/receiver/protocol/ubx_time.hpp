/// UBX messages of time: NAV-TIME…, NAV-CLOCK and TIM.
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

/// NAV-TIMEUTC: the epoch in UTC.
struct NavTimeutc {
    static constexpr UbxMessageId message_id{0x01, 0x21};
    std::uint32_t i_tow = 0;  ///< ms, GPS time of week of the epoch
    std::uint32_t t_acc = 0;  ///< ns
    std::int32_t nano = 0;    ///< ns
    std::uint16_t year = 0;
    std::uint8_t month = 0;  ///< 1 to 12
    std::uint8_t day = 0;
    std::uint8_t hour = 0;
    std::uint8_t minute = 0;
    std::uint8_t second = 0;  ///< 0 to 60
    std::uint8_t valid = 0;   ///< bits: 0 time of week, 1 week, 2 UTC, 4-7 standard
};

/// NAV-TIMEGPS: the epoch in GPS time.
struct NavTimegps {
    static constexpr UbxMessageId message_id{0x01, 0x20};
    std::uint32_t i_tow = 0;  ///< ms, GPS time of week of the epoch
    std::int32_t f_tow = 0;   ///< ns to add to i_tow
    std::int16_t week = 0;    ///< GPS week, not wrapped
    std::int8_t leap_s = 0;   ///< s, GPS time minus UTC
    std::uint8_t valid = 0;   ///< bits: 0 time of week, 1 week, 2 leap seconds
    std::uint32_t t_acc = 0;  ///< ns
};

/// NAV-CLOCK: the receiver's clock.
struct NavClock {
    static constexpr UbxMessageId message_id{0x01, 0x22};
    std::uint32_t i_tow = 0;  ///< ms, GPS time of week of the epoch
    std::int32_t clk_b = 0;   ///< ns, bias
    std::int32_t clk_d = 0;   ///< ns/s, drift
    std::uint32_t t_acc = 0;  ///< ns
    std::uint32_t f_acc = 0;  ///< ps/s
};

/// TIM-TP: the time of the next pulse, by the time base that the pulses are aligned to.
struct TimTp {
    static constexpr UbxMessageId message_id{0x0D, 0x01};
    std::uint32_t tow_ms = 0;      ///< ms
    std::uint32_t tow_sub_ms = 0;  ///< 2^-32 ms
    std::int32_t q_err = 0;        ///< ps, quantisation of the pulse
    std::uint16_t week = 0;        ///< of the next pulse
    std::uint8_t flags = 0;        ///< bits: 0 UTC base, 1 UTC available, 2-3 RAIM, 4 q_err invalid
    std::uint8_t ref_info = 0;     ///< bits: 0-3 reference GNSS, 4-7 UTC standard
};

/// The epoch in the time of a system that counts weeks (RECEIVER.md 3.1; QZSS: M10 interface description).
template <std::uint8_t Id>
struct NavSystemTime {
    static constexpr UbxMessageId message_id{0x01, Id};
    std::uint32_t i_tow = 0;  ///< ms, GPS time of week of the epoch
    std::uint32_t tow = 0;    ///< s, time of week
    std::int32_t f_tow = 0;   ///< ns to add, -5e8 to 5e8
    std::int16_t week = 0;
    std::int8_t leap_s = 0;   ///< s, against UTC
    std::uint8_t valid = 0;   ///< bits: 0 time of week, 1 week, 2 leap seconds
    std::uint32_t t_acc = 0;  ///< ns
};
using NavTimebds = NavSystemTime<0x24>;   ///< NAV-TIMEBDS
using NavTimegal = NavSystemTime<0x25>;   ///< NAV-TIMEGAL
using NavTimeqzss = NavSystemTime<0x27>;  ///< NAV-TIMEQZSS

/// NAV-TIMEGLO: the epoch in GLONASS time, UTC and three hours (RECEIVER.md 3.1).
struct NavTimeglo {
    static constexpr UbxMessageId message_id{0x01, 0x23};
    std::uint32_t i_tow = 0;  ///< ms, GPS time of week of the epoch
    std::uint32_t tod = 0;    ///< s, time of day
    std::int32_t f_tod = 0;   ///< ns to add, -5e8 to 5e8
    std::uint16_t n_t = 0;    ///< day of the four years, from 1
    std::uint8_t n_4 = 0;     ///< four years since 1996, from 1
    std::uint8_t valid = 0;   ///< bits: 0 time of day, 1 date
    std::uint32_t t_acc = 0;  ///< ns
};

/// NAV-TIMELS: leap seconds (RECEIVER.md 3.1).
struct NavTimels {
    static constexpr UbxMessageId message_id{0x01, 0x26};
    std::uint32_t i_tow = 0;   ///< ms, GPS time of week of the epoch
    std::uint8_t version = 0;  ///< 0
    std::array<std::uint8_t, 3> reserved0{};
    std::uint8_t src_of_curr_ls =
        0;                    ///< 0 firmware, 1 GLONASS, 2 GPS, 3 SBAS, 4 BeiDou, 5 Galileo, 7 configured, 255 unknown
    std::int8_t curr_ls = 0;  ///< s since 1980
    std::uint8_t src_of_ls_change = 0;    ///< 0 none, 2 GPS, 3 SBAS, 4 BeiDou, 5 Galileo, 6 GLONASS
    std::int8_t ls_change = 0;            ///< s: 0, 1, -1
    std::int32_t time_to_ls_event = 0;    ///< s, negative after it
    std::uint16_t date_of_ls_gps_wn = 0;  ///< week
    std::uint16_t date_of_ls_gps_dn = 0;  ///< day of the week, 1 Sunday
    std::array<std::uint8_t, 3> reserved1{};
    std::uint8_t valid = 0;  ///< bits: 0 current number, 1 time to the event
};

/// TIM-TM2: a mark on an input pin (RECEIVER.md 3.2).
struct TimTm2 {
    static constexpr UbxMessageId message_id{0x0D, 0x03};
    std::uint8_t ch = 0;  ///< input
    std::uint8_t flags =
        0;  ///< bits: 0 running mode, 1 run, 2 new falling edge, 3-4 time base, 5 UTC, 6 time valid, 7 new rising edge
    std::uint16_t count = 0;         ///< of rising edges
    std::uint16_t wn_r = 0;          ///< week of the rising edge
    std::uint16_t wn_f = 0;          ///< week of the falling edge
    std::uint32_t tow_ms_r = 0;      ///< ms
    std::uint32_t tow_sub_ms_r = 0;  ///< ns
    std::uint32_t tow_ms_f = 0;      ///< ms
    std::uint32_t tow_sub_ms_f = 0;  ///< ns
    std::uint32_t acc_est = 0;       ///< ns
};

/// TIM-VRFY: sourced time against that of the receiver (M8 interface description).
struct TimVrfy {
    static constexpr UbxMessageId message_id{0x0D, 0x06};
    std::int32_t itow = 0;      ///< ms
    std::int32_t frac = 0;      ///< ns
    std::int32_t delta_ms = 0;  ///< ms
    std::int32_t delta_ns = 0;  ///< ns
    std::uint16_t wno = 0;
    std::uint8_t flags = 0;  ///< bits 0-2: source
    std::uint8_t reserved = 0;
};

}  // namespace skyloop::inline receiver
