#include "receiver/protocol/decoded_message.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "base/core/words.hpp"
#include "receiver/protocol/casic_messages.hpp"
#include "receiver/protocol/dronecan_listing.hpp"
#include "receiver/protocol/field_lister.hpp"
#include "receiver/protocol/known_sbf.hpp"
#include "receiver/protocol/mavlink_vehicle.hpp"
#include "receiver/protocol/msp.hpp"
#include "receiver/protocol/unicore_frame.hpp"
#include "receiver/protocol/unicore_logs.hpp"

namespace skyloop::inline receiver {
namespace {

constexpr std::size_t rtcm3_frame_head = 3, rtcm3_frame_tail = 3;

template <class Message>
void list_message(const Message& found, DecodedMessage& message) {
    FieldLister lister;
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

template <class Message>
bool list_casic_as(const CasicFrameView& frame, DecodedMessage& message) {
    if (frame.id != Message::message_id) return false;
    message.name = Message::message_name;
    const auto found = decode_payload<Message>(frame.payload);
    if (found) list_message(*found, message);
    return found.has_value();
}

// A poll has no payload, and so no fields.
void list_casic(const CasicFrameView& frame, DecodedMessage& message) {
    message.id = fmt::format("{:02X}-{:02X}", frame.id.message_class, frame.id.id);
    const bool known = KnownCasicMessages::any([&]<class Message>() { return list_casic_as<Message>(frame, message); });
    if (!known) keep_payload(frame.payload, message);
}

template <class Message>
bool list_unicore_as(const UnicoreFrameView& frame, DecodedMessage& message) {
    if constexpr (UnicoreBinaryLog<Message>) {
        if (frame.id != Message::message_id) return false;
        message.name = Message::message_name;
        const auto found = decode_front<Message>(frame.payload);
        if (found) list_message(*found, message);
        return found.has_value();
    } else {
        return false;
    }
}

// What a head says stands before the fields of the body.
void add_unicore_time(const UnicoreHeader& header, DecodedMessage& message) {
    const auto whole = [](std::int64_t value) { return DecodedValue{value}; };
    std::vector<DecodedField> fields{{"week", header.time_known ? whole(header.week) : DecodedValue{}},
                                     {"tow_s", header.time_known ? DecodedValue{header.tow_ms * 1e-3} : DecodedValue{}},
                                     {"leap_s", whole(header.leap_seconds)}};
    std::ranges::move(message.fields, std::back_inserter(fields));
    message.fields = std::move(fields);
}

void list_unicore_frame(const UnicoreFrameView& frame, DecodedMessage& message) {
    message.id = fmt::format("{}", frame.id);
    const bool known = KnownUnicoreLogs::any([&]<class Message>() { return list_unicore_as<Message>(frame, message); });
    if (!known) keep_payload(frame.payload, message);
    if (known) add_unicore_time(frame.header, message);
}

template <class Message>
bool list_unicore_as(const UnicoreLineView& line, DecodedMessage& message) {
    if (line.name.substr(0, line.name.size() - 1) != Message::message_name || line.name.back() != 'A') return false;
    message.name = Message::message_name;
    const auto found = read_unicore_body<Message>(line.fields);
    if (found) list_message(*found, message);
    return found.has_value();
}

// Of answers, and of logs that are not known, the fields as they stand.
void list_unicore_line(const UnicoreLineView& line, DecodedMessage& message) {
    message.id = line.name;
    const bool known = !line.name.empty() && line.lead == '#' &&
                       KnownUnicoreLogs::any([&]<class Message>() { return list_unicore_as<Message>(line, message); });
    if (!known) {
        std::vector<DecodedValue> fields;
        for (const std::string_view field : line.fields)
            fields.push_back({std::string(field)});
        message.fields.push_back({"fields", {std::move(fields)}});
    }
    if (line.header) add_unicore_time(*line.header, message);
}

void list_unicore(ByteSpan bytes, DecodedMessage& message) {
    if (const auto frame = parse_unicore_frame(bytes)) return list_unicore_frame(*frame, message);
    const std::string text = to_string(bytes);
    if (const auto line = parse_unicore_line(text)) list_unicore_line(*line, message);
}

}  // namespace

std::string_view stream_kind_name(StreamKind kind) {
    constexpr std::array<std::string_view, stream_kind_count> names{
        "ubx", "nmea", "rtcm3", "noise", "msp", "mavlink", "sbf", "command", "unicore", "can", "casic"};
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
    } else if (piece.kind == StreamKind::unicore) {
        list_unicore(bytes, message);
    } else if (piece.kind == StreamKind::casic) {
        if (const auto frame = parse_casic_frame(bytes)) list_casic(*frame, message);
    } else if (piece.kind == StreamKind::can) {
        const std::string line = to_string(bytes);
        if (const auto frame = parse_slcan_line(std::string_view(line).substr(0, line.find('\r'))))
            list_can(*frame, message);
    } else if (piece.kind == StreamKind::command) {
        message.fields.push_back({"line", {to_string(bytes)}});
    } else {
        keep_payload(bytes, message);
    }
    return message;
}

namespace {

std::string hex_of(ByteSpan bytes) {
    std::string text;
    text.reserve(2 * bytes.size());
    for (const std::uint8_t byte : bytes)
        fmt::format_to(std::back_inserter(text), "{:02x}", byte);
    return text;
}

// Quoted where it could be taken for something else.
std::string text_word(const std::string& word) {
    for (const char c : word)
        if (c <= ' ' || c > '~' || c == '"' || c == '=' || c == '[' || c == '{') return json_string(word);
    return word.empty() ? "\"\"" : word;
}

// Values as JSON, or as a line of words.
class ShownValue {
public:
    explicit ShownValue(bool json) : json_(json) {}

    std::string operator()(std::monostate) const { return json_ ? "null" : "-"; }
    std::string operator()(std::int64_t value) const { return fmt::format("{}", value); }
    std::string operator()(std::uint64_t value) const { return fmt::format("{}", value); }
    std::string operator()(double value) const {
        if (!std::isfinite(value)) return (*this)(std::monostate());
        // JSON has no "-0"; and what is whole is written as whole.
        return value == 0 ? "0" : fmt::format("{}", value);
    }
    std::string operator()(const std::string& value) const { return json_ ? json_string(value) : text_word(value); }
    std::string operator()(const std::vector<DecodedValue>& values) const {
        std::string text;
        for (const DecodedValue& value : values)
            add(text, std::visit(*this, value.content));
        return '[' + text + ']';
    }
    std::string operator()(const std::vector<DecodedField>& fields) const { return '{' + list(fields) + '}'; }
    /// Without the braces.
    [[nodiscard]] std::string list(const std::vector<DecodedField>& fields) const {
        std::string text;
        for (const DecodedField& field : fields)
            add(text,
                (json_ ? json_string(field.name) + ':' : field.name + '=') + std::visit(*this, field.value.content));
        return text;
    }

private:
    void add(std::string& text, const std::string& item) const {
        if (!text.empty()) text += json_ ? ',' : ' ';
        text += item;
    }
    bool json_;
};

}  // namespace

std::string json_string(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\')
            out += {'\\', c};
        else if (byte < 0x20 || byte > 0x7E)
            out += fmt::format("\\u{:04x}", byte);
        else
            out += c;
    }
    return out + '"';
}

std::string json_line(const DecodedMessage& message, std::uint64_t offset) {
    std::string text = fmt::format("{{\"protocol\":{},\"offset\":{},\"bytes\":{},\"id\":{}",
                                   json_string(message.protocol), offset, message.bytes, json_string(message.id));
    if (!message.name.empty()) text += ",\"name\":" + json_string(message.name);
    if (!message.fields.empty()) text += ",\"fields\":" + ShownValue(true)(message.fields);
    if (!message.payload.empty()) text += ",\"payload\":\"" + hex_of(message.payload) + '"';
    return text + '}';
}

std::string text_line(const DecodedMessage& message) {
    std::string text = upper_case(message.protocol) + ' ' + (message.name.empty() ? message.id : message.name);
    if (!message.fields.empty()) text += ' ' + ShownValue(false).list(message.fields);
    if (!message.payload.empty()) text += fmt::format(" {} bytes {}", message.payload.size(), hex_of(message.payload));
    return text;
}

}  // namespace skyloop::inline receiver
