/// UBX messages of time: NAV-TIME…, NAV-CLOCK and TIM.
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

/// NAV-TIMEUTC: the epoch in UTC.
struct NavTimeutc {
    static constexpr UbxMessageId message_id{0x01, 0x21};
    U4<"tow_s*1e-3"> i_tow{};  ///< GPS time of week of the epoch
    U4<"t_acc_ns"> t_acc{};
    I4<"nano_ns"> nano{};
    U2<"year"> year{};
    U1<"month"> month{};  ///< 1 to 12
    U1<"day"> day{};
    U1<"hour"> hour{};
    U1<"minute"> minute{};
    U1<"second"> second{};  ///< 0 to 60
    U1<"valid"> valid{};    ///< bits: 0 time of week, 1 week, 2 UTC, 4-7 standard
};

/// NAV-TIMEGPS: the epoch in GPS time.
struct NavTimegps {
    static constexpr UbxMessageId message_id{0x01, 0x20};
    U4<"tow_s*1e-3"> i_tow{};       ///< GPS time of week of the epoch
    I4<"tow_fraction_ns"> f_tow{};  ///< to add to i_tow
    I2<"week"> week{};              ///< GPS week, not wrapped
    I1<"leap_seconds"> leap_s{};    ///< GPS time minus UTC
    U1<"valid"> valid{};            ///< bits: 0 time of week, 1 week, 2 leap seconds
    U4<"t_acc_ns"> t_acc{};
};

/// NAV-CLOCK: the receiver's clock.
struct NavClock {
    static constexpr UbxMessageId message_id{0x01, 0x22};
    U4<"tow_s*1e-3"> i_tow{};  ///< GPS time of week of the epoch
    I4<"bias_ns"> clk_b{};     ///< bias
    I4<"drift_nsps"> clk_d{};  ///< drift
    U4<"t_acc_ns"> t_acc{};
    U4<"f_acc_psps"> f_acc{};
};

/// TIM-TP: the time of the next pulse, by the time base that the pulses are aligned to.
struct TimTp {
    static constexpr UbxMessageId message_id{0x0D, 0x01};
    U4<"tow_s*1e-3"> tow_ms{};
    U4<"tow_fraction_ms*2^-32"> tow_sub_ms{};
    I4<"quantisation_ps"> q_err{};  ///< quantisation of the pulse
    U2<"week"> week{};              ///< of the next pulse
    U1<"flags"> flags{};            ///< bits: 0 UTC base, 1 UTC available, 2-3 RAIM, 4 q_err invalid
    U1<"reference"> ref_info{};     ///< bits: 0-3 reference GNSS, 4-7 UTC standard
};

/// The epoch in the time of a system that counts weeks (RECEIVER.md 3.1; QZSS: M10 interface description).
template <std::uint8_t Id, FieldText Tow>
struct NavSystemTime {
    static constexpr UbxMessageId message_id{0x01, Id};
    U4<"tow_s*1e-3"> i_tow{};  ///< GPS time of week of the epoch
    U4<Tow> tow{};
    I4<"tow_fraction_ns"> f_tow{};  ///< to add, -5e8 to 5e8
    I2<"week"> week{};
    I1<"leap_seconds"> leap_s{};  ///< against UTC
    U1<"valid"> valid{};          ///< bits: 0 time of week, 1 week, 2 leap seconds
    U4<"t_acc_ns"> t_acc{};
};
using NavTimebds = NavSystemTime<0x24, "beidou_tow_s">;   ///< NAV-TIMEBDS
using NavTimegal = NavSystemTime<0x25, "galileo_tow_s">;  ///< NAV-TIMEGAL
using NavTimeqzss = NavSystemTime<0x27, "qzss_tow_s">;    ///< NAV-TIMEQZSS

/// NAV-TIMEGLO: the epoch in GLONASS time, UTC and three hours (RECEIVER.md 3.1).
struct NavTimeglo {
    static constexpr UbxMessageId message_id{0x01, 0x23};
    U4<"tow_s*1e-3"> i_tow{};        ///< GPS time of week of the epoch
    U4<"time_of_day_s"> tod{};       ///< time of day
    I4<"tow_fraction_ns"> f_tod{};   ///< to add, -5e8 to 5e8
    U2<"day"> n_t{};                 ///< day of the four years, from 1
    U1<"four_year_interval"> n_4{};  ///< four years since 1996, from 1
    U1<"valid"> valid{};             ///< bits: 0 time of day, 1 date
    U4<"t_acc_ns"> t_acc{};
};

/// NAV-TIMELS: leap seconds (RECEIVER.md 3.1).
struct NavTimels {
    static constexpr UbxMessageId message_id{0x01, 0x26};
    U4<"tow_s*1e-3"> i_tow{};  ///< GPS time of week of the epoch
    U1<"version"> version{};   ///< 0
    std::array<std::uint8_t, 3> reserved0{};
    U1<"leap_source">
        src_of_curr_ls{};  ///< 0 firmware, 1 GLONASS, 2 GPS, 3 SBAS, 4 BeiDou, 5 Galileo, 7 configured, 255 unknown
    I1<"leap_seconds"> curr_ls{};               ///< since 1980
    U1<"change_source"> src_of_ls_change{};     ///< 0 none, 2 GPS, 3 SBAS, 4 BeiDou, 5 Galileo, 6 GLONASS
    I1<"change_s"> ls_change{};                 ///< s: 0, 1, -1
    I4<"time_to_change_s"> time_to_ls_event{};  ///< negative after it
    U2<"change_week"> date_of_ls_gps_wn{};      ///< week
    U2<"change_day"> date_of_ls_gps_dn{};       ///< day of the week, 1 Sunday
    std::array<std::uint8_t, 3> reserved1{};
    U1<"valid"> valid{};  ///< bits: 0 current number, 1 time to the event
};

/// TIM-TM2: a mark on an input pin (RECEIVER.md 3.2).
struct TimTm2 {
    static constexpr UbxMessageId message_id{0x0D, 0x03};
    U1<"channel"> ch{};   ///< input
    U1<"flags"> flags{};  ///< bits: 0 running mode, 1 run, 2 new falling edge, 3-4 time base, 5 UTC, 6 time valid, 7
                          ///< new rising edge
    U2<"count"> count{};  ///< of rising edges
    U2<"week_rising"> wn_r{};   ///< week of the rising edge
    U2<"week_falling"> wn_f{};  ///< week of the falling edge
    U4<"tow_rising_s*1e-3"> tow_ms_r{};
    U4<"tow_rising_ns"> tow_sub_ms_r{};
    U4<"tow_falling_s*1e-3"> tow_ms_f{};
    U4<"tow_falling_ns"> tow_sub_ms_f{};
    U4<"acc_ns"> acc_est{};
};

/// TIM-VRFY: sourced time against that of the receiver (M8 interface description).
struct TimVrfy {
    static constexpr UbxMessageId message_id{0x0D, 0x06};
    I4<"tow_s*1e-3"> itow{};
    I4<"tow_fraction_ns"> frac{};
    I4<"delta_ms"> delta_ms{};
    I4<"delta_ns"> delta_ns{};
    U2<"week"> wno{};
    U1<"flags"> flags{};  ///< bits 0-2: source
    std::uint8_t reserved = 0;
};

}  // namespace skyloop::inline receiver
