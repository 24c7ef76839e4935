/// UBX messages of the front end: MON-HW, MON-HW2, MON-HW3, MON-RF and MON-SPAN.
///
/// Fields are declared as field.hpp says. Each message names where its layout stands: a
/// section of RECEIVER.md, or the message of that name in the M8 (UBX-13003221), F9 (HPG 1.32, UBX-22008968) or M10
/// (SPG 5.10) interface description.
///
/// UBX messages of class SEC beside SEC-UNIQID.
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

/// MON-HW: pins, gain, antenna and jamming (RECEIVER.md 3.2). Pins that VP lists: 17 on u-blox 7 and later, 25
/// before; the 56 bytes of later receivers stand in no document, and are taken as 13.
template <std::size_t Pins>
struct MonHwPins {
    static constexpr UbxMessageId message_id{0x0A, 0x09};
    U4<"pin_select"> pin_sel{};
    U4<"pin_bank"> pin_bank{};
    U4<"pin_direction"> pin_dir{};
    U4<"pin_value"> pin_val{};
    U2<"noise"> noise_per_ms{};
    U2<"agc"> agc_cnt{};              ///< 0 to 8191
    U1<"antenna_status"> a_status{};  ///< 0 initialising, 1 unknown, 2 ok, 3 short circuit, 4 open
    U1<"antenna_power"> a_power{};    ///< 0 off, 1 on, 2 unknown
    U1<"flags"> flags{};              ///< bits: 0 clock calibrated, 1 safe boot, 2-3 jamming state, 4 no crystal
    std::uint8_t reserved0 = 0;
    U4<"used_mask"> used_mask{};
    U1<"virtual_pins", Pins> vp{};
    U1<"jamming_indicator"> jam_ind{};  ///< 0 to 255
    std::array<std::uint8_t, 2> reserved1{};
    U4<"pin_interrupts"> pin_irq{};
    U4<"pull_up"> pull_h{};
    U4<"pull_down"> pull_l{};
};

using MonHw = MonHwPins<17>;
using MonHwLong = MonHwPins<25>;
using MonHwShort = MonHwPins<13>;

/// MON-HW2: the front end's measurements (RECEIVER.md 3.2).
struct MonHw2 {
    static constexpr UbxMessageId message_id{0x0A, 0x0B};
    I1<"offset_i"> ofs_i{};
    U1<"magnitude_i"> mag_i{};
    I1<"offset_q"> ofs_q{};
    U1<"magnitude_q"> mag_q{};
    U1<"config_source"> cfg_source{};  ///< 114 ROM, 111 OTP, 112 pins, 102 flash
    std::array<std::uint8_t, 3> reserved0{};
    U4<"low_level_config"> low_lev_cfg{};
    std::array<std::uint8_t, 8> reserved1{};
    U4<"post_status"> post_status{};
    std::array<std::uint8_t, 4> reserved2{};
};

/// One pin of MON-HW3.
struct MonHw3Item {
    U2<"id"> pin_id{};
    U2<"mask">
        pin_mask{};  ///< bits: 0 peripheral, 1-3 bank, 4 output, 5 high, 6 virtual, 7 interrupt, 8 pull-up, 9 pull-down
    U1<"virtual_pin"> vp{};  ///< virtual pin
    std::uint8_t reserved1 = 0;
};

/// MON-HW3: pins (RECEIVER.md 3.2).
struct MonHw3 {
    static constexpr UbxMessageId message_id{0x0A, 0x37};
    U1<"version"> version{};  ///< 0
    U1<"flags"> flags{};      ///< bits: 0 clock calibrated, 1 safe boot, 2 no crystal
    Text<"hardware", 10> hw_version{};
    std::array<std::uint8_t, 9> reserved0{};
    List<"pins", MonHw3Item> pins;

    static void fields(auto& m, auto& v) {
        v(m.version);
        v.count(m.pins);
        v(m.flags, m.hw_version, m.reserved0);
        v.items(m.pins);
    }
};

/// One front end of MON-RF.
struct MonRfItem {
    U1<"id"> block_id{};                ///< 0 L1, 1 L2 or L5
    U1<"flags"> flags{};                ///< bits 0-1: jamming state
    U1<"antenna_status"> ant_status{};  ///< as MonHwPins::a_status
    U1<"antenna_power"> ant_power{};    ///< as MonHwPins::a_power
    U4<"post_status"> post_status{};
    std::array<std::uint8_t, 4> reserved1{};
    U2<"noise"> noise_per_ms{};
    U2<"agc"> agc_cnt{};                ///< 0 to 8191
    U1<"jamming_indicator"> jam_ind{};  ///< 0 to 255
    I1<"offset_i"> ofs_i{};
    U1<"magnitude_i"> mag_i{};
    I1<"offset_q"> ofs_q{};
    U1<"magnitude_q"> mag_q{};
    std::array<std::uint8_t, 3> reserved2{};
};

/// MON-RF: front ends (RECEIVER.md 3.2).
struct MonRf {
    static constexpr UbxMessageId message_id{0x0A, 0x38};
    U1<"version"> version{};  ///< 0
    std::array<std::uint8_t, 2> reserved0{};
    List<"blocks", MonRfItem> blocks;

    static void fields(auto& m, auto& v) {
        v(m.version);
        v.count(m.blocks);
        v(m.reserved0);
        v.items(m.blocks);
    }
};

/// One front end of MON-SPAN.
struct MonSpanItem {
    U1<"spectrum_db*2^-2", 256> spectrum{};
    U4<"span_hz"> span{};
    U4<"resolution_hz"> res{};
    U4<"centre_hz"> center{};
    U1<"gain_db"> pga{};
    std::array<std::uint8_t, 3> reserved1{};
};

/// MON-SPAN: spectra (F9 interface description).
struct MonSpan {
    static constexpr UbxMessageId message_id{0x0A, 0x31};
    U1<"version"> version{};  ///< 0
    std::array<std::uint8_t, 2> reserved0{};
    List<"blocks", MonSpanItem> blocks;

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
    static constexpr std::uint8_t layout_version = 1;  ///< tells it from the other layout, which may be as long
    U1<"version"> version = 1;                         ///< 1
    std::array<std::uint8_t, 3> reserved0{};
    U1<"jamming_flags"> jam_flags{};  ///< bits: 0 detection on, 1-2 jamming state
    std::array<std::uint8_t, 3> reserved1{};
    U1<"spoofing_flags"> spf_flags{};  ///< bits: 0 detection on, 1-3 spoofing state
    std::array<std::uint8_t, 3> reserved2{};
};

/// One band of SEC-SIG version 2.
struct SecSigBand {
    U8<"centre_khz"> centre{};  ///< 24 bits
    U1<"jammed"> jammed{};      ///< bits: 0 jammed

    static void fields(auto& m, auto& v) {
        v.sized(m.centre, 3);
        v(m.jammed);
    }
};

/// SEC-SIG version 2: jamming by band, and spoofing (RECEIVER.md 3.2).
struct SecSig2 {
    static constexpr UbxMessageId message_id{0x27, 0x09};
    static constexpr std::uint8_t layout_version = 2;  ///< tells it from the other layout, which may be as long
    U1<"version"> version = 2;                         ///< 2
    U1<"flags"> sig_sec_flags{};  ///< bits: 0 jamming detection on, 1-2 jamming state, 3 spoofing detection on, 4-6
                                  ///< spoofing state
    std::uint8_t reserved0 = 0;
    List<"bands", SecSigBand> bands;

    static void fields(auto& m, auto& v) {
        v(m.version, m.sig_sec_flags, m.reserved0);
        v.count(m.bands);
        v.items(m.bands);
    }
};

/// One event of SEC-SIGLOG.
struct SecSiglogItem {
    U4<"age_s*1e-3"> time_elapsed{};   ///< since then
    U1<"detection"> detection_type{};  ///< 0 simulated signal, 3 abrupt change, 4 jamming, 5 authentication, 6 replay
    U1<"event"> event_type{};          ///< 0 started, 1 stopped, 2 triggered, 3 timed out
    std::array<std::uint8_t, 2> reserved1{};
};

/// SEC-SIGLOG: the last events of jamming and spoofing, at most 16 (RECEIVER.md 3.2).
struct SecSiglog {
    static constexpr UbxMessageId message_id{0x27, 0x10};
    U1<"version"> version = 1;  ///< 1
    std::array<std::uint8_t, 6> reserved0{};
    List<"events", SecSiglogItem> events;

    static void fields(auto& m, auto& v) {
        v(m.version);
        v.count(m.events);
        v(m.reserved0);
        v.items(m.events);
    }
};

}  // namespace skyloop::inline receiver
