#include "receiver/protocol/dronecan_transfer.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "base/core/crc16.hpp"

namespace skyloop::inline receiver {
namespace {

constexpr std::uint8_t start_bit = 0x80, end_bit = 0x40, toggle_bit = 0x20, id_bits = 0x1F;
constexpr std::uint32_t service_bit = 0x80, request_bit = 0x8000, node_bits = 0x7F;
constexpr std::uint16_t crc_start = 0xFFFF;
constexpr std::size_t frame_payload = 7, crc_size = 2;
constexpr std::chrono::seconds transfer_timeout{2};

std::uint16_t seed_of(std::uint64_t signature) {
    Bytes bytes;
    for (unsigned shift = 0; shift < 64; shift += 8)
        bytes.push_back(static_cast<std::uint8_t>(signature >> shift));
    return crc16_ccitt(bytes, crc_start);
}

// Of anonymous messages so that two nodes that speak at once do not win together: by what they say.
std::uint32_t discriminator(ByteSpan payload) { return crc16_ccitt(payload, crc_start) & 0x3FFFU; }

std::uint32_t id_of(const DronecanTransfer& t) {
    const std::uint32_t priority = static_cast<std::uint32_t>(t.priority & id_bits) << 24;
    if (t.kind == DronecanKind::message && t.source == 0)
        return priority | discriminator(t.payload) << 10 | (t.type_id & 3U) << 8;
    if (t.kind == DronecanKind::message) return priority | std::uint32_t{t.type_id} << 8 | t.source;
    return priority | (t.type_id & 0xFFU) << 16 | (t.kind == DronecanKind::request ? request_bit : 0) |
           (t.destination & node_bits) << 8 | service_bit | t.source;
}

}  // namespace

const DronecanType* find_dronecan_type(DronecanKind kind, std::uint16_t id) {
    const DronecanType* found = nullptr;
    KnownDronecanTypes::any([&]<class Message>() {
        if (Message::type.kind == kind && Message::type.id == id) found = &Message::type;
        return found != nullptr;
    });
    return found;
}

std::vector<CanFrame> dronecan_frames(const DronecanTransfer& transfer, std::uint64_t signature) {
    const bool single = transfer.payload.size() <= frame_payload;
    const bool anonymous = transfer.kind == DronecanKind::message && transfer.source == 0;
    if ((anonymous && !single) || transfer.payload.size() > TransferReceiver::longest_payload) return {};
    Bytes bytes;
    if (!single) {
        const std::uint16_t crc = crc16_ccitt(transfer.payload, seed_of(signature));
        bytes = {static_cast<std::uint8_t>(crc & 0xFFU), static_cast<std::uint8_t>(crc >> 8)};
    }
    bytes.insert(bytes.end(), transfer.payload.begin(), transfer.payload.end());
    std::vector<CanFrame> frames;
    bool toggle = false;
    for (std::size_t at = 0; at == 0 || at < bytes.size(); at += frame_payload) {
        const std::size_t size = std::min(frame_payload, bytes.size() - at);
        CanFrame frame{id_of(transfer), true, static_cast<std::uint8_t>(size + 1)};
        std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), size, frame.data.begin());
        const unsigned place = (at == 0 ? start_bit : 0U) | (at + size == bytes.size() ? end_bit : 0U);
        frame.data[size] =
            static_cast<std::uint8_t>(place | (toggle ? toggle_bit : 0U) | (transfer.transfer_id & id_bits));
        toggle = !toggle;
        frames.push_back(frame);
    }
    return frames;
}

std::optional<DronecanTransfer> dronecan_head(const CanFrame& frame) {
    if (!frame.extended || frame.size == 0) return std::nullopt;
    DronecanTransfer head;
    head.priority = static_cast<std::uint8_t>(frame.id >> 24 & id_bits);
    head.source = static_cast<std::uint8_t>(frame.id & node_bits);
    head.transfer_id = frame.data[frame.size - 1U] & id_bits;
    head.type_id = static_cast<std::uint16_t>(frame.id >> 8 & 0xFFFFU);
    if ((frame.id & service_bit) != 0) {
        head.kind = (frame.id & request_bit) != 0 ? DronecanKind::request : DronecanKind::response;
        head.type_id = static_cast<std::uint16_t>(frame.id >> 16 & 0xFFU);
        head.destination = static_cast<std::uint8_t>(frame.id >> 8 & node_bits);
        if (head.source == 0 || head.destination == 0) return std::nullopt;
    } else if (head.source == 0) {
        head.type_id &= 3U;
    }
    return head;
}

TransferReceiver::Session* TransferReceiver::session_of(std::uint32_t key, GpsTime now) {
    if (sessions_.size() >= most_sessions && !sessions_.contains(key))
        std::erase_if(sessions_, [&](const auto& entry) { return now - entry.second.last > transfer_timeout; });
    if (sessions_.size() >= most_sessions && !sessions_.contains(key)) return nullptr;
    return &sessions_[key];
}

// Begins a transfer, unless it is the last one again.
bool TransferReceiver::begins(Session& session, const Piece& piece, GpsTime now) {
    if (session.begun) ++counts_.unfinished;
    session.begun = false;
    if (session.last_id == piece.transfer_id && now - session.last <= transfer_timeout) {
        ++counts_.repeated;
        return false;
    }
    session.bytes.clear();
    session.begun = true;
    session.transfer_id = piece.transfer_id;
    return true;
}

// Whether the frame is the next one of the session's transfer.
bool TransferReceiver::continues(Session& session, const Piece& piece, GpsTime now) {
    if (session.begun && now - session.last > transfer_timeout) {
        session.begun = false;
        ++counts_.unfinished;
    }
    const bool next = session.begun && session.toggle == piece.toggle && session.transfer_id == piece.transfer_id;
    if (!next) {
        session.begun = false;
        ++counts_.out_of_order;
    }
    return next;
}

// The payload of a whole transfer, or nothing where its CRC does not hold.
std::optional<Bytes> TransferReceiver::payload_of(const Session& session, const DronecanType& type) {
    const ByteSpan bytes(session.bytes);
    if (bytes.size() >= crc_size) {
        const ByteSpan payload = bytes.subspan(crc_size);
        const unsigned said = bytes[0] | static_cast<unsigned>(bytes[1]) << 8;
        if (crc16_ccitt(payload, seed_of(type.signature)) == said) return Bytes(payload.begin(), payload.end());
    }
    ++counts_.bad_crc;
    return std::nullopt;
}

std::optional<Bytes> TransferReceiver::collect(Session& session, const Piece& piece, const DronecanType& type) {
    session.toggle = !piece.toggle;
    session.bytes.insert(session.bytes.end(), piece.bytes.begin(), piece.bytes.end());
    if (session.bytes.size() > longest_payload + crc_size) {
        session.begun = false;
        ++counts_.malformed;
        return std::nullopt;
    }
    if (!piece.ends) return std::nullopt;
    session.begun = false;
    auto payload = piece.starts ? std::optional(session.bytes) : payload_of(session, type);
    if (payload) session.last_id = piece.transfer_id;
    return payload;
}

TransferReceiver::Piece TransferReceiver::piece_of(const CanFrame& frame) {
    const std::uint8_t tail = frame.data[frame.size - 1U];
    return {ByteSpan(frame.data).first(frame.size - 1U), (tail & start_bit) != 0, (tail & end_bit) != 0,
            (tail & toggle_bit) != 0, static_cast<std::uint8_t>(tail & id_bits)};
}

std::optional<DronecanTransfer> TransferReceiver::take(const CanFrame& frame, GpsTime now) {
    auto head = dronecan_head(frame);
    const Piece piece = head ? piece_of(frame) : Piece{};
    const bool anonymous = head && head->source == 0;
    if (!head || (piece.starts && piece.toggle) || (!piece.ends && piece.bytes.size() != frame_payload) ||
        (anonymous && !(piece.starts && piece.ends))) {
        ++counts_.malformed;
        return std::nullopt;
    }
    const DronecanType* type = find_dronecan_type(head->kind, head->type_id);
    if (type == nullptr) return std::nullopt;
    std::optional<Bytes> payload;
    if (anonymous) {
        payload.emplace(piece.bytes.begin(), piece.bytes.end());
    } else {
        Session* const session = session_of(frame.id & 0xFF'FFFFU, now);
        if (session == nullptr || !(piece.starts ? begins(*session, piece, now) : continues(*session, piece, now)))
            return std::nullopt;
        session->last = now;
        payload = collect(*session, piece, *type);
    }
    if (!payload) return std::nullopt;
    ++counts_.transfers;
    head->payload = std::move(*payload);
    return head;
}

}  // namespace skyloop::inline receiver
