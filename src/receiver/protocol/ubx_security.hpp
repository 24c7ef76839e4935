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

namespace skyloop {

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

    template <class M, class V>
    static void fields(M& m, V& v) {
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

    template <class M, class V>
    static void fields(M& m, V& v) {
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

    template <class M, class V>
    static void fields(M& m, V& v) {
        v(m.version);
        v.count(m.events);
        v(m.reserved0);
        v.items(m.events);
    }
};

}  // namespace skyloop
