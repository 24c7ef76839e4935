/// UBX messages CFG-VALSET, CFG-VALGET and CFG-VALDEL (F9 interface description, section 3.10).
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

namespace skyloop {

/// Bytes of the value that a key names by its bits 28 to 30; 0 when they name none.
constexpr std::size_t config_value_size(std::uint32_t key) {
    constexpr std::array<std::size_t, 8> sizes{0, 1, 1, 2, 4, 8, 0, 0};
    return sizes[key >> 28 & 7u];
}

/// A key and its value, as many bytes of it as the key says. A key without a size fails to decode.
struct ConfigPair {
    std::uint32_t key = 0;
    std::uint64_t value = 0;

    template <class M, class V>
    static void fields(M& m, V& v) {
        v(m.key);
        v.sized(m.value, config_value_size(m.key));
    }
};

/// CFG-VALSET: set values.
struct CfgValset {
    static constexpr UbxMessageId message_id{0x06, 0x8A};
    std::uint8_t version = 0;      ///< 0 or 1
    std::uint8_t layers = 0;       ///< bits: 0 RAM, 1 battery-backed RAM, 2 flash
    std::uint8_t transaction = 0;  ///< 0 none, 1 begin, 2 continue, 3 apply
    std::uint8_t reserved = 0;
    std::vector<ConfigPair> pairs;

    template <class M, class V>
    static void fields(M& m, V& v) {
        v(m.version, m.layers, m.transaction, m.reserved);
        v.rest(m.pairs, 0, 64);
    }
};

/// CFG-VALGET, the question.
struct CfgValgetPoll {
    static constexpr UbxMessageId message_id{0x06, 0x8B};
    std::uint8_t version = 0;    ///< 0
    std::uint8_t layer = 0;      ///< 0 RAM, 1 battery-backed RAM, 2 flash, 7 default
    std::uint16_t position = 0;  ///< how many to skip
    std::vector<std::uint32_t> keys;

    template <class M, class V>
    static void fields(M& m, V& v) {
        v(m.version, m.layer, m.position);
        v.rest(m.keys, 0, 64);
    }
};

/// CFG-VALGET, the answer.
struct CfgValget {
    static constexpr UbxMessageId message_id{0x06, 0x8B};
    std::uint8_t version = 0;    ///< 1
    std::uint8_t layer = 0;      ///< as asked
    std::uint16_t position = 0;  ///< as asked
    std::vector<ConfigPair> pairs;

    template <class M, class V>
    static void fields(M& m, V& v) {
        v(m.version, m.layer, m.position);
        v.rest(m.pairs, 0, 64);
    }
};

/// CFG-VALDEL: back to the layer below.
struct CfgValdel {
    static constexpr UbxMessageId message_id{0x06, 0x8C};
    std::uint8_t version = 0;      ///< 0 or 1
    std::uint8_t layers = 0;       ///< bits: 1 battery-backed RAM, 2 flash
    std::uint8_t transaction = 0;  ///< as CfgValset::transaction
    std::uint8_t reserved = 0;
    std::vector<std::uint32_t> keys;

    template <class M, class V>
    static void fields(M& m, V& v) {
        v(m.version, m.layers, m.transaction, m.reserved);
        v.rest(m.keys, 0, 64);
    }
};

}  // namespace skyloop
