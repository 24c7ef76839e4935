#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "detail/known_mavlink.hpp"
#include "receiver/protocol/known_sbf.hpp"
#include "receiver/protocol/message_listing.hpp"
#include "receiver/protocol/msp.hpp"

namespace skyloop {
namespace {

constexpr std::size_t rtcm3_frame_head = 3, rtcm3_frame_tail = 3;

template <class Message>
void list_message(const Message& found, DecodedMessage& message) {
    FieldLister lister(Message::field_names);
    walk_fields(found, lister);
    message.fields = lister.take();
}

void keep_payload(ByteSpan payload, DecodedMessage& message) { message.payload.assign(payload.begin(), payload.end()); }

template <class Message>
bool list_msp_as(const MspFrameView& frame, DecodedMessage& message) {
    if (frame.function != Message::function || frame.payload.empty()) return false;
    const auto found = decode_front<Message>(frame.payload);
    message.name = Message::message_name;
    if (found) list_message(*found, message);
    return found.has_value();
}

void list_msp(const MspFrameView& frame, DecodedMessage& message) {
    message.id = frame.version == 1 ? fmt::format("{}", frame.function) : fmt::format("0x{:04X}", frame.function);
    if (list_msp_as<MspSensorGps>(frame, message) || list_msp_as<MspSetRawGps>(frame, message)) return;
    keep_payload(frame.payload, message);
}

// Counts the fields of a message that lie before its extensions.
class BaseFields {
public:
    explicit BaseFields(std::size_t base_size) : left_(base_size) {}
    template <class... T>
    void operator()(const T&... field) {
        (take(wire_size_of(field)), ...);
    }
    [[nodiscard]] std::size_t count() const { return count_; }

private:
    template <class T>
    static std::size_t wire_size_of(const T& field) {
        return sizeof field;  // numbers and arrays of them
    }
    void take(std::size_t size) {
        if (left_ == 0) return;
        left_ -= std::min(size, left_);
        ++count_;
    }
    std::size_t left_, count_ = 0;
};

// Frames of version 1 have no extensions.
template <class Message>
void leave_out_extensions(DecodedMessage& message) {
    BaseFields base(Message::base_size);
    const Message any{};
    walk_fields(any, base);
    for (std::size_t i = base.count(); i < message.fields.size(); ++i)
        message.fields[i].value = {};
}

template <class Message>
bool list_mavlink_as(const MavlinkFrameView& frame, DecodedMessage& message) {
    if (frame.message != Message::message_id) return false;
    message.name = Message::message_name;
    list_message(decode_mavlink<Message>(frame.payload), message);
    if (frame.version == 1) leave_out_extensions<Message>(message);
    return true;
}

void list_mavlink(const MavlinkFrameView& frame, DecodedMessage& message) {
    message.id = fmt::format("{}", frame.message);
    const bool known =
        KnownMavlinkMessages::any([&]<class Message>() { return list_mavlink_as<Message>(frame, message); });
    if (!known) return keep_payload(frame.payload, message);
    const auto number = [](unsigned value) { return DecodedValue{std::uint64_t{value}}; };
    std::vector<DecodedField> fields{{"system", number(frame.source.system)},
                                     {"component", number(frame.source.component)},
                                     {"sequence", number(frame.source.sequence)}};
    for (DecodedField& field : message.fields)
        fields.push_back(std::move(field));
    message.fields = std::move(fields);
}

template <class Message>
bool list_sbf_as(const SbfBlockView& block, DecodedMessage& message) {
    if (block.number != Message::block_number) return false;
    message.name = Message::message_name;
    const auto found = decode_sbf<Message>(block.body);
    if (found) list_message(*found, message);
    return found.has_value();
}

void list_sbf(const SbfBlockView& block, DecodedMessage& message) {
    message.id = fmt::format("{}", block.number);
    const bool known = KnownSbfBlocks::any([&]<class Message>() { return list_sbf_as<Message>(block, message); });
    if (!known) keep_payload(block.body, message);
}

}  // namespace

std::string_view stream_kind_name(StreamKind kind) {
    constexpr std::array<std::string_view, stream_kind_count> names{"ubx", "nmea",    "rtcm3", "noise",
                                                                    "msp", "mavlink", "sbf",   "command"};
    return names[static_cast<std::size_t>(kind)];
}

DecodedMessage decode_piece(const StreamPiece& piece) {
    DecodedMessage message;
    message.protocol = stream_kind_name(piece.kind);
    message.bytes = piece.bytes.size();
    const ByteSpan bytes(piece.bytes);
    if (piece.kind == StreamKind::ubx) {
        if (const auto frame = parse_frame(bytes)) list_ubx(*frame, message);
    } else if (piece.kind == StreamKind::nmea) {
        const std::string line = to_string(bytes);
        const std::string_view trimmed = std::string_view(line).substr(0, line.find_last_not_of("\r\n") + 1);
        if (const auto sentence = parse_sentence(trimmed)) list_nmea(*sentence, message);
    } else if (piece.kind == StreamKind::rtcm3) {
        if (bytes.size() >= rtcm3_frame_head + rtcm3_frame_tail)
            list_rtcm3(bytes.subspan(rtcm3_frame_head, bytes.size() - rtcm3_frame_head - rtcm3_frame_tail), message);
    } else if (piece.kind == StreamKind::msp) {
        if (const auto frame = parse_msp(bytes)) list_msp(*frame, message);
    } else if (piece.kind == StreamKind::mavlink) {
        if (const auto frame = parse_mavlink(bytes)) list_mavlink(*frame, message);
    } else if (piece.kind == StreamKind::sbf) {
        if (const auto block = parse_sbf(bytes)) list_sbf(*block, message);
    } else if (piece.kind == StreamKind::command) {
        message.fields.push_back({"line", {to_string(bytes)}});
    } else {
        keep_payload(bytes, message);
    }
    return message;
}

}  // namespace skyloop
