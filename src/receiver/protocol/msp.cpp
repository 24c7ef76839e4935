#include "receiver/protocol/msp.hpp"

namespace skyloop::inline receiver {
namespace {

constexpr std::uint8_t msp_v1_mark = 'M', msp_v2_mark = 'X';

bool is_msp_direction(std::uint8_t c) { return c == '<' || c == '>' || c == '!'; }

std::uint8_t exclusive_or(ByteSpan bytes) {
    std::uint8_t sum = 0;
    for (const std::uint8_t byte : bytes)
        sum = static_cast<std::uint8_t>(sum ^ byte);
    return sum;
}

}  // namespace

std::uint8_t crc8_dvb_s2(ByteSpan bytes) {
    unsigned crc = 0;
    for (const std::uint8_t byte : bytes) {
        crc ^= byte;
        for (int bit = 0; bit < 8; ++bit)
            crc = (crc & 0x80u) != 0 ? (crc << 1 ^ 0xD5u) & 0xFFu : crc << 1;
    }
    return static_cast<std::uint8_t>(crc);
}

Bytes encode_msp_v1(std::uint16_t function, ByteSpan payload) {
    if (function > 0xFF || payload.size() > msp_v1_largest_payload) return {};
    Bytes frame{'$', msp_v1_mark, '<', static_cast<std::uint8_t>(payload.size()), static_cast<std::uint8_t>(function)};
    frame.insert(frame.end(), payload.begin(), payload.end());
    frame.push_back(exclusive_or(ByteSpan(frame).subspan(3)));
    return frame;
}

Bytes encode_msp_v2(std::uint16_t function, ByteSpan payload) {
    if (payload.size() > 0xFFFF) return {};
    const auto low = [](std::size_t value) { return static_cast<std::uint8_t>(value & 0xFF); };
    const auto high = [](std::size_t value) { return static_cast<std::uint8_t>(value >> 8); };
    Bytes frame{'$', msp_v2_mark, '<', 0, low(function), high(function), low(payload.size()), high(payload.size())};
    frame.insert(frame.end(), payload.begin(), payload.end());
    frame.push_back(crc8_dvb_s2(ByteSpan(frame).subspan(3)));
    return frame;
}

std::optional<std::size_t> msp_frame_size(ByteSpan bytes) {
    if (bytes.size() < msp_v1_head_size || bytes[0] != '$' || !is_msp_direction(bytes[2])) return std::nullopt;
    if (bytes[1] == msp_v1_mark) {
        if (bytes[3] > msp_v1_largest_payload) return std::nullopt;
        return msp_v1_head_size + bytes[3] + 1;
    }
    if (bytes[1] != msp_v2_mark || bytes.size() < msp_v2_head_size) return std::nullopt;
    return msp_v2_head_size + bytes[6] + std::size_t{256} * bytes[7] + 1;
}

std::optional<MspFrameView> parse_msp(ByteSpan bytes) {
    const auto size = msp_frame_size(bytes);
    if (!size || *size != bytes.size()) return std::nullopt;
    const ByteSpan covered = bytes.subspan(3, *size - 4);
    const bool first = bytes[1] == msp_v1_mark;
    if ((first ? exclusive_or(covered) : crc8_dvb_s2(covered)) != bytes.back()) return std::nullopt;
    const auto direction = static_cast<char>(bytes[2]);
    if (first) return MspFrameView{1, direction, bytes[4], bytes.subspan(msp_v1_head_size, bytes[3])};
    return MspFrameView{2, direction, static_cast<std::uint16_t>(bytes[4] | bytes[5] << 8),
                        bytes.subspan(msp_v2_head_size, *size - msp_v2_head_size - 1)};
}

}  // namespace skyloop::inline receiver
