#include "receiver/protocol/casic_frame.hpp"

namespace skyloop::inline receiver {
namespace {

constexpr std::size_t casic_word = 4;

std::uint32_t casic_word_at(ByteSpan bytes, std::size_t at) {
    std::uint32_t word = 0;
    for (std::size_t i = casic_word; i-- > 0;)
        word = word << 8 | bytes[at + i];
    return word;
}

}  // namespace

std::uint32_t casic_checksum(CasicMessageId id, ByteSpan payload) {
    std::uint32_t sum = std::uint32_t{id.id} << 24 | std::uint32_t{id.message_class} << 16;
    sum += static_cast<std::uint32_t>(payload.size());
    for (std::size_t at = 0; at + casic_word <= payload.size(); at += casic_word)
        sum += casic_word_at(payload, at);
    return sum;
}

Bytes encode_casic_frame(CasicMessageId id, ByteSpan payload) {
    if (payload.size() > casic_largest_payload || payload.size() % casic_word != 0) return {};
    Bytes frame{casic_sync_1,
                casic_sync_2,
                static_cast<std::uint8_t>(payload.size() & 0xFF),
                static_cast<std::uint8_t>(payload.size() >> 8),
                id.message_class,
                id.id};
    frame.insert(frame.end(), payload.begin(), payload.end());
    const std::uint32_t sum = casic_checksum(id, payload);
    for (int shift = 0; shift < 32; shift += 8)
        frame.push_back(static_cast<std::uint8_t>(sum >> shift & 0xFF));
    return frame;
}

std::optional<std::size_t> casic_frame_size(ByteSpan bytes) {
    if (bytes.size() < casic_head_size || bytes[0] != casic_sync_1 || bytes[1] != casic_sync_2) return std::nullopt;
    const std::size_t length = bytes[2] + std::size_t{256} * bytes[3];
    if (length > casic_largest_payload || length % casic_word != 0) return std::nullopt;
    return casic_head_size + length + casic_sum_size;
}

std::optional<CasicFrameView> parse_casic_frame(ByteSpan bytes) {
    const auto size = casic_frame_size(bytes);
    if (!size || bytes.size() != *size) return std::nullopt;
    const CasicFrameView frame{{bytes[4], bytes[5]},
                               bytes.subspan(casic_head_size, *size - casic_head_size - casic_sum_size)};
    if (casic_checksum(frame.id, frame.payload) != casic_word_at(bytes, *size - casic_sum_size)) return std::nullopt;
    return frame;
}

}  // namespace skyloop::inline receiver
