/// UBX messages of classes ACK, MON, SEC and INF.
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

/// ACK-ACK: a configuration message was done.
struct AckAck {
    static constexpr UbxMessageId message_id{0x05, 0x01};
    std::uint8_t message_class = 0;
    std::uint8_t id = 0;

    template <class M, class V>
    static void fields(M& m, V& v) {
        v(m.message_class, m.id);
    }
};

/// ACK-NAK: a configuration message was refused.
struct AckNak {
    static constexpr UbxMessageId message_id{0x05, 0x00};
    std::uint8_t message_class = 0;
    std::uint8_t id = 0;

    template <class M, class V>
    static void fields(M& m, V& v) {
        v(m.message_class, m.id);
    }
};

/// A fixed text field, filled up with zeros.
template <std::size_t N>
struct UbxText {
    std::array<char, N> characters{};

    template <class M, class V>
    static void fields(M& m, V& v) {
        v(m.characters);
    }
};

/// MON-VER: who the receiver is; texts filled up with zeros.
struct MonVer {
    static constexpr UbxMessageId message_id{0x0A, 0x04};
    std::array<char, 30> sw_version{};
    std::array<char, 10> hw_version{};
    std::vector<UbxText<30>> extensions;

    template <class M, class V>
    static void fields(M& m, V& v) {
        v(m.sw_version, m.hw_version);
        v.rest(m.extensions, 0, 2000);
    }
};

/// SEC-UNIQID: the chip; five bytes in version 1, six in version 2 (M10).
struct SecUniqid {
    static constexpr UbxMessageId message_id{0x27, 0x03};
    std::uint8_t version = 0;
    std::array<std::uint8_t, 3> reserved{};
    std::vector<std::uint8_t> unique_id;

    template <class M, class V>
    static void fields(M& m, V& v) {
        v(m.version, m.reserved);
        v.rest(m.unique_id, 5, 6);
    }
};

/// INF: a notice to the user, ISO 8859-1, not terminated.
template <std::uint8_t Id>
struct Inf {
    static constexpr UbxMessageId message_id{0x04, Id};
    std::vector<char> text;

    template <class M, class V>
    static void fields(M& m, V& v) {
        v.rest(m.text, 0, 65535);
    }
};

using InfError = Inf<0x00>;
using InfWarning = Inf<0x01>;
using InfNotice = Inf<0x02>;
using InfTest = Inf<0x03>;
using InfDebug = Inf<0x04>;

}  // namespace skyloop
