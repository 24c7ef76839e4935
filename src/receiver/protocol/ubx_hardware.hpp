/// UBX messages of the front end: MON-HW, MON-HW2, MON-HW3, MON-RF and MON-SPAN.
///
/// Numbers are as on the wire; a member's comment gives unit and scale. Each message names where its layout stands: a
/// section of RECEIVER.md, or the message of that name in the M8 (UBX-13003221), F9 (HPG 1.32, UBX-22008968) or M10
/// (SPG 5.10) interface description.
///
/// UBX messages of class SEC beside SEC-UNIQID.
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

/// MON-HW: pins, gain, antenna and jamming (RECEIVER.md 3.2). Pins that VP lists: 17 on u-blox 7 and later, 25
/// before; the 56 bytes of later receivers stand in no document, and are taken as 13.
template <std::size_t Pins>
struct MonHwPins {
    static constexpr UbxMessageId message_id{0x0A, 0x09};
    std::uint32_t pin_sel = 0;
    std::uint32_t pin_bank = 0;
    std::uint32_t pin_dir = 0;
    std::uint32_t pin_val = 0;
    std::uint16_t noise_per_ms = 0;
    std::uint16_t agc_cnt = 0;  ///< 0 to 8191
    std::uint8_t a_status = 0;  ///< 0 initialising, 1 unknown, 2 ok, 3 short circuit, 4 open
    std::uint8_t a_power = 0;   ///< 0 off, 1 on, 2 unknown
    std::uint8_t flags = 0;     ///< bits: 0 clock calibrated, 1 safe boot, 2-3 jamming state, 4 no crystal
    std::uint8_t reserved0 = 0;
    std::uint32_t used_mask = 0;
    std::array<std::uint8_t, Pins> vp{};
    std::uint8_t jam_ind = 0;  ///< 0 to 255
    std::array<std::uint8_t, 2> reserved1{};
    std::uint32_t pin_irq = 0;
    std::uint32_t pull_h = 0;
    std::uint32_t pull_l = 0;
};

using MonHw = MonHwPins<17>;
using MonHwLong = MonHwPins<25>;
using MonHwShort = MonHwPins<13>;

/// MON-HW2: the front end's measurements (RECEIVER.md 3.2).
struct MonHw2 {
    static constexpr UbxMessageId message_id{0x0A, 0x0B};
    std::int8_t ofs_i = 0;
    std::uint8_t mag_i = 0;
    std::int8_t ofs_q = 0;
    std::uint8_t mag_q = 0;
    std::uint8_t cfg_source = 0;  ///< 114 ROM, 111 OTP, 112 pins, 102 flash
    std::array<std::uint8_t, 3> reserved0{};
    std::uint32_t low_lev_cfg = 0;
    std::array<std::uint8_t, 8> reserved1{};
    std::uint32_t post_status = 0;
    std::array<std::uint8_t, 4> reserved2{};
};

/// One pin of MON-HW3.
struct MonHw3Item {
    std::uint16_t pin_id = 0;
    std::uint16_t pin_mask =
        0;  ///< bits: 0 peripheral, 1-3 bank, 4 output, 5 high, 6 virtual, 7 interrupt, 8 pull-up, 9 pull-down
    std::uint8_t vp = 0;  ///< virtual pin
    std::uint8_t reserved1 = 0;
};

/// MON-HW3: pins (RECEIVER.md 3.2).
struct MonHw3 {
    static constexpr UbxMessageId message_id{0x0A, 0x37};
    std::uint8_t version = 0;  ///< 0
    std::uint8_t flags = 0;    ///< bits: 0 clock calibrated, 1 safe boot, 2 no crystal
    std::array<char, 10> hw_version{};
    std::array<std::uint8_t, 9> reserved0{};
    std::vector<MonHw3Item> pins;

    static void fields(auto& m, auto& v) {
        v(m.version);
        v.count(m.pins);
        v(m.flags, m.hw_version, m.reserved0);
        v.items(m.pins);
    }
};

/// One front end of MON-RF.
struct MonRfItem {
    std::uint8_t block_id = 0;    ///< 0 L1, 1 L2 or L5
    std::uint8_t flags = 0;       ///< bits 0-1: jamming state
    std::uint8_t ant_status = 0;  ///< as MonHwPins::a_status
    std::uint8_t ant_power = 0;   ///< as MonHwPins::a_power
    std::uint32_t post_status = 0;
    std::array<std::uint8_t, 4> reserved1{};
    std::uint16_t noise_per_ms = 0;
    std::uint16_t agc_cnt = 0;  ///< 0 to 8191
    std::uint8_t jam_ind = 0;   ///< 0 to 255
    std::int8_t ofs_i = 0;
    std::uint8_t mag_i = 0;
    std::int8_t ofs_q = 0;
    std::uint8_t mag_q = 0;
    std::array<std::uint8_t, 3> reserved2{};
};

/// MON-RF: front ends (RECEIVER.md 3.2).
struct MonRf {
    static constexpr UbxMessageId message_id{0x0A, 0x38};
    std::uint8_t version = 0;  ///< 0
    std::array<std::uint8_t, 2> reserved0{};
    std::vector<MonRfItem> blocks;

    static void fields(auto& m, auto& v) {
        v(m.version);
        v.count(m.blocks);
        v(m.reserved0);
        v.items(m.blocks);
    }
};

/// One front end of MON-SPAN.
struct MonSpanItem {
    std::array<std::uint8_t, 256> spectrum{};  ///< 0.25 dB
    std::uint32_t span = 0;                    ///< Hz
    std::uint32_t res = 0;                     ///< Hz
    std::uint32_t center = 0;                  ///< Hz
    std::uint8_t pga = 0;                      ///< dB
    std::array<std::uint8_t, 3> reserved1{};
};

/// MON-SPAN: spectra (F9 interface description).
struct MonSpan {
    static constexpr UbxMessageId message_id{0x0A, 0x31};
    std::uint8_t version = 0;  ///< 0
    std::array<std::uint8_t, 2> reserved0{};
    std::vector<MonSpanItem> blocks;

    static void fields(auto& m, auto& v) {
        v(m.version);
        v.count(m.blocks);
        v(m.reserved0);
        v.items(m.blocks);
    }
};

/// SEC-SIG version 1: jamming and spoofing (RECEIVER.md 3.2).
struct SecSig1 {
    static constexpr UbxMessageId message_id{0x27, 0x09};
    std::uint8_t version = 1;  ///< 1
    std::array<std::uint8_t, 3> reserved0{};
    std::uint8_t jam_flags = 0;  ///< bits: 0 detection on, 1-2 jamming state
    std::array<std::uint8_t, 3> reserved1{};
    std::uint8_t spf_flags = 0;  ///< bits: 0 detection on, 1-3 spoofing state
    std::array<std::uint8_t, 3> reserved2{};
};

/// One band of SEC-SIG version 2.
struct SecSigBand {
    std::uint64_t centre = 0;  ///< kHz, 24 bits
    std::uint8_t jammed = 0;   ///< bits: 0 jammed

    static void fields(auto& m, auto& v) {
        v.sized(m.centre, 3);
        v(m.jammed);
    }
};

/// SEC-SIG version 2: jamming by band, and spoofing (RECEIVER.md 3.2).
struct SecSig2 {
    static constexpr UbxMessageId message_id{0x27, 0x09};
    std::uint8_t version = 2;  ///< 2
    std::uint8_t sig_sec_flags =
        0;  ///< bits: 0 jamming detection on, 1-2 jamming state, 3 spoofing detection on, 4-6 spoofing state
    std::uint8_t reserved0 = 0;
    std::vector<SecSigBand> bands;

    static void fields(auto& m, auto& v) {
        v(m.version, m.sig_sec_flags, m.reserved0);
        v.count(m.bands);
        v.items(m.bands);
    }
};

/// One event of SEC-SIGLOG.
struct SecSiglogItem {
    std::uint32_t time_elapsed = 0;   ///< ms since then
    std::uint8_t detection_type = 0;  ///< 0 simulated signal, 3 abrupt change, 4 jamming, 5 authentication, 6 replay
    std::uint8_t event_type = 0;      ///< 0 started, 1 stopped, 2 triggered, 3 timed out
    std::array<std::uint8_t, 2> reserved1{};
};

/// SEC-SIGLOG: the last events of jamming and spoofing, at most 16 (RECEIVER.md 3.2).
struct SecSiglog {
    static constexpr UbxMessageId message_id{0x27, 0x10};
    std::uint8_t version = 1;  ///< 1
    std::array<std::uint8_t, 6> reserved0{};
    std::vector<SecSiglogItem> events;

    static void fields(auto& m, auto& v) {
        v(m.version);
        v.count(m.events);
        v(m.reserved0);
        v.items(m.events);
    }
};

}  // namespace skyloop::inline receiver
