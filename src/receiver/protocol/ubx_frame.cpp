#include "receiver/protocol/ubx_frame.hpp"

namespace skyloop::inline receiver {

UbxChecksum ubx_checksum(ByteSpan bytes) {
    UbxChecksum sum;
    for (const std::uint8_t byte : bytes) {
        sum.a = static_cast<std::uint8_t>(sum.a + byte);
        sum.b = static_cast<std::uint8_t>(sum.b + sum.a);
    }
    return sum;
}

Bytes encode_frame(UbxMessageId id, ByteSpan payload) {
    Bytes frame;
    if (payload.size() > ubx_largest_payload) return frame;
    frame.reserve(ubx_head_size + payload.size() + ubx_tail_size);
    frame = {ubx_sync_1,
             ubx_sync_2,
             id.message_class,
             id.id,
             static_cast<std::uint8_t>(payload.size() & 0xFF),
             static_cast<std::uint8_t>(payload.size() >> 8)};
    frame.insert(frame.end(), payload.begin(), payload.end());
    const UbxChecksum sum = ubx_checksum(ByteSpan(frame).subspan(2));
    frame.push_back(sum.a);
    frame.push_back(sum.b);
    return frame;
}

std::optional<UbxFrameView> parse_frame(ByteSpan bytes) {
    if (bytes.size() < ubx_head_size + ubx_tail_size) return std::nullopt;
    if (bytes[0] != ubx_sync_1 || bytes[1] != ubx_sync_2) return std::nullopt;
    const std::size_t length = bytes[4] + std::size_t{256} * bytes[5];
    if (bytes.size() != ubx_head_size + length + ubx_tail_size) return std::nullopt;
    const UbxChecksum said{bytes[bytes.size() - 2], bytes[bytes.size() - 1]};
    if (ubx_checksum(bytes.subspan(2, ubx_head_size - 2 + length)) != said) return std::nullopt;
    return UbxFrameView{{bytes[2], bytes[3]}, bytes.subspan(ubx_head_size, length)};
}

}  // namespace skyloop::inline receiver
