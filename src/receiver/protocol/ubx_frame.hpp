/// UBX frames: sync, message, length, payload, checksum (u-blox M8 protocol specification, section 32.2).
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "base/core/bytes.hpp"

namespace skyloop::inline receiver {

/// Which message a frame carries.
struct UbxMessageId {
    std::uint8_t message_class = 0, id = 0;
    auto operator<=>(const UbxMessageId&) const = default;
};

inline constexpr std::uint8_t ubx_sync_1 = 0xB5, ubx_sync_2 = 0x62;
/// Bytes before the payload: sync, class, id, length.
inline constexpr std::size_t ubx_head_size = 6;
/// Bytes after it: the checksum.
inline constexpr std::size_t ubx_tail_size = 2;
/// The most that the length field can say.
inline constexpr std::size_t ubx_largest_payload = 65535;

/// Fletcher's checksum of RFC 1145 in eight bits: the sum of the bytes, and the sum of those sums.
struct UbxChecksum {
    std::uint8_t a = 0, b = 0;
    bool operator==(const UbxChecksum&) const = default;
};

/// Over class, id, length and payload, without the sync.
UbxChecksum ubx_checksum(ByteSpan bytes);

/// One checked frame; the payload lives as long as the bytes that were parsed.
struct UbxFrameView {
    UbxMessageId id;
    ByteSpan payload;
};

/// The whole frame. Empty when the payload exceeds `ubx_largest_payload`, which no frame can carry.
Bytes encode_frame(UbxMessageId id, ByteSpan payload);

/// Reads exactly one frame; nothing when sync, length or checksum do not hold.
std::optional<UbxFrameView> parse_frame(ByteSpan bytes);

}  // namespace skyloop::inline receiver
