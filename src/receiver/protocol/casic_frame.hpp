/// Frames of CASIC receivers (AT6558 and its like: ATGM336H, ATGM332D, Quectel L76K).
///
/// BA CE, u16 length of the payload, u8 class, u8 id, payload in words of four bytes, u32 sum of words; little-endian.
/// Sources: CASIC Multimode Satellite Navigation Receiver Protocol Specification V4.2.0.3, section 2.2
/// (icofchina.com); ntpsec/gpsd, drivers/driver_casic.c; captures in jclark/satpulse (gps/casic/casbin), each
/// recomputed.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "base/core/bytes.hpp"

namespace skyloop::inline receiver {

inline constexpr std::uint8_t casic_sync_1 = 0xBA, casic_sync_2 = 0xCE;
inline constexpr std::size_t casic_head_size = 6, casic_sum_size = 4;
/// A payload has less than 2 kB.
inline constexpr std::size_t casic_largest_payload = 2044;

/// Which message a frame carries.
struct CasicMessageId {
    std::uint8_t message_class = 0, id = 0;
    auto operator<=>(const CasicMessageId&) const = default;
};

/// The sum of the words of length, class and id, and of the payload, whose size is a multiple of four.
std::uint32_t casic_checksum(CasicMessageId id, ByteSpan payload);

/// One checked frame; the payload lives as long as the bytes that were parsed.
struct CasicFrameView {
    CasicMessageId id;
    ByteSpan payload;
};

/// The whole frame. Empty for a payload that no frame can carry: of more than casic_largest_payload bytes, or no
/// multiple of four.
Bytes encode_casic_frame(CasicMessageId id, ByteSpan payload);
/// Bytes of the frame that begins here, by its head; nothing when none does or the head is not whole.
std::optional<std::size_t> casic_frame_size(ByteSpan bytes);
/// Reads exactly one frame; nothing when sync, length or sum do not hold.
std::optional<CasicFrameView> parse_casic_frame(ByteSpan bytes);

}  // namespace skyloop::inline receiver
