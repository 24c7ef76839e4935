#include "receiver/protocol/mavlink.hpp"

#include <algorithm>

#include "detail/known_mavlink.hpp"

namespace skyloop {
namespace {

constexpr std::uint8_t mavlink_signed_flag = 0x01;

void append_mavlink_crc(Bytes& frame, std::uint8_t extra) {
    const std::uint16_t crc = crc16_x25({&extra, 1}, crc16_x25(ByteSpan(frame).subspan(1)));
    frame.push_back(static_cast<std::uint8_t>(crc & 0xFF));
    frame.push_back(static_cast<std::uint8_t>(crc >> 8));
}

MavlinkFrameView mavlink_view(ByteSpan bytes) {
    if (bytes[0] == mavlink_v1_start)
        return {1, {bytes[3], bytes[4], bytes[2]}, bytes[5], false, bytes.subspan(mavlink_v1_head_size, bytes[1])};
    const bool is_signed = (bytes[2] & mavlink_signed_flag) != 0;
    return {2,
            {bytes[5], bytes[6], bytes[4]},
            *mavlink_message_id(bytes),
            is_signed,
            bytes.subspan(mavlink_v2_head_size, bytes[1])};
}

}  // namespace

std::uint16_t crc16_x25(ByteSpan bytes, std::uint16_t crc) {
    unsigned sum = crc;
    for (const std::uint8_t byte : bytes) {
        sum ^= byte;
        for (int bit = 0; bit < 8; ++bit)
            sum = (sum & 1u) != 0 ? sum >> 1 ^ 0x8408u : sum >> 1;
    }
    return static_cast<std::uint16_t>(sum);
}

std::optional<std::uint8_t> mavlink_crc_extra(std::uint32_t message) {
    std::optional<std::uint8_t> extra;
    KnownMavlinkMessages::any([&]<class Message>() {
        if (Message::message_id == message) extra = Message::crc_extra;
        return extra.has_value();
    });
    return extra;
}

Bytes encode_mavlink_v2(MavlinkSource source, std::uint32_t message, ByteSpan payload) {
    const auto extra = mavlink_crc_extra(message);
    if (!extra || payload.size() > 0xFF) return {};
    while (payload.size() > 1 && payload.back() == 0)
        payload = payload.first(payload.size() - 1);
    const auto byte = [message](int shift) { return static_cast<std::uint8_t>(message >> shift & 0xFF); };
    Bytes frame{mavlink_v2_start,
                static_cast<std::uint8_t>(payload.size()),
                0,
                0,
                source.sequence,
                source.system,
                source.component,
                byte(0),
                byte(8),
                byte(16)};
    frame.insert(frame.end(), payload.begin(), payload.end());
    append_mavlink_crc(frame, *extra);
    return frame;
}

Bytes encode_mavlink_v1(MavlinkSource source, std::uint32_t message, ByteSpan payload) {
    const auto extra = mavlink_crc_extra(message);
    if (!extra || payload.size() > 0xFF || message > 0xFF) return {};
    Bytes frame{mavlink_v1_start, static_cast<std::uint8_t>(payload.size()), source.sequence, source.system,
                source.component, static_cast<std::uint8_t>(message)};
    frame.insert(frame.end(), payload.begin(), payload.end());
    append_mavlink_crc(frame, *extra);
    return frame;
}

std::optional<std::size_t> mavlink_frame_size(ByteSpan bytes) {
    if (bytes.size() >= mavlink_v1_head_size && bytes[0] == mavlink_v1_start)
        return mavlink_v1_head_size + bytes[1] + mavlink_crc_size;
    if (bytes.size() < mavlink_v2_head_size || bytes[0] != mavlink_v2_start) return std::nullopt;
    const bool is_signed = (bytes[2] & mavlink_signed_flag) != 0;
    return mavlink_v2_head_size + bytes[1] + mavlink_crc_size + (is_signed ? mavlink_signature_size : 0);
}

std::optional<std::uint32_t> mavlink_message_id(ByteSpan bytes) {
    if (bytes.size() >= mavlink_v1_head_size && bytes[0] == mavlink_v1_start) return bytes[5];
    if (bytes.size() < mavlink_v2_head_size || bytes[0] != mavlink_v2_start) return std::nullopt;
    return bytes[7] | std::uint32_t{bytes[8]} << 8 | std::uint32_t{bytes[9]} << 16;
}

std::optional<MavlinkFrameView> parse_mavlink(ByteSpan bytes) {
    const auto size = mavlink_frame_size(bytes);
    if (!size || *size != bytes.size()) return std::nullopt;
    if (bytes[0] == mavlink_v2_start && (bytes[2] & ~mavlink_signed_flag) != 0) return std::nullopt;
    const MavlinkFrameView frame = mavlink_view(bytes);
    const auto extra = mavlink_crc_extra(frame.message);
    if (!extra) return std::nullopt;
    const auto covered = static_cast<std::size_t>(frame.payload.data() - bytes.data()) + frame.payload.size();
    const std::uint16_t crc = crc16_x25({&*extra, 1}, crc16_x25(bytes.subspan(1, covered - 1)));
    if (bytes[covered] != (crc & 0xFF) || bytes[covered + 1] != crc >> 8) return std::nullopt;
    return frame;
}

std::vector<MavlinkFrameView> mavlink_frames(ByteSpan datagram) {
    std::vector<MavlinkFrameView> frames;
    while (!datagram.empty()) {
        const auto size = mavlink_frame_size(datagram);
        if (!size) {
            datagram = datagram.subspan(1);
            continue;
        }
        if (*size > datagram.size()) break;
        if (const auto frame = parse_mavlink(datagram.first(*size))) frames.push_back(*frame);
        datagram = datagram.subspan(*size);
    }
    return frames;
}

}  // namespace skyloop
