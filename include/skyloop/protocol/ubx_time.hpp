/// UBX messages of time: NAV-TIMEUTC, NAV-TIMEGPS, NAV-CLOCK and TIM-TP.
///
/// Numbers are as on the wire; a member's comment gives unit and scale. Sections are those of the u-blox M8 interface
/// description (UBX-13003221) and, where named, of the F9 one (HPG 1.32, UBX-22008968).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "skyloop/protocol/ubx_fields.hpp"

namespace skyloop {

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

    template <class M, class V>
    static void fields(M& m, V& v) {
        v(m.i_tow, m.t_acc, m.nano, m.year, m.month, m.day, m.hour, m.minute, m.second, m.valid);
    }
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

    template <class M, class V>
    static void fields(M& m, V& v) {
        v(m.i_tow, m.f_tow, m.week, m.leap_s, m.valid, m.t_acc);
    }
};

/// NAV-CLOCK: the receiver's clock.
struct NavClock {
    static constexpr UbxMessageId message_id{0x01, 0x22};
    std::uint32_t i_tow = 0;  ///< ms, GPS time of week of the epoch
    std::int32_t clk_b = 0;   ///< ns, bias
    std::int32_t clk_d = 0;   ///< ns/s, drift
    std::uint32_t t_acc = 0;  ///< ns
    std::uint32_t f_acc = 0;  ///< ps/s

    template <class M, class V>
    static void fields(M& m, V& v) {
        v(m.i_tow, m.clk_b, m.clk_d, m.t_acc, m.f_acc);
    }
};

/// TIM-TP: the time of the next pulse.
struct TimTp {
    static constexpr UbxMessageId message_id{0x0D, 0x01};
    std::uint32_t tow_ms = 0;      ///< ms
    std::uint32_t tow_sub_ms = 0;  ///< 2^-32 ms
    std::int32_t q_err = 0;        ///< ps, quantisation of the pulse
    std::uint16_t week = 0;        ///< of the next pulse
    std::uint8_t flags = 0;        ///< bits: 0 UTC base, 1 UTC available, 2-3 RAIM, 4 q_err invalid
    std::uint8_t ref_info = 0;     ///< bits: 0-3 reference GNSS, 4-7 UTC standard

    template <class M, class V>
    static void fields(M& m, V& v) {
        v(m.tow_ms, m.tow_sub_ms, m.q_err, m.week, m.flags, m.ref_info);
    }
};

}  // namespace skyloop
