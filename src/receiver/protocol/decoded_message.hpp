/// Messages of any protocol as named values, for people and programs to read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/core/bytes.hpp"
#include "receiver/protocol/stream_splitter.hpp"

namespace skyloop::inline receiver {

struct DecodedField;

/// A value: nothing (the sender has none), a number in the unit of its field's name, a text, a list or a group.
struct DecodedValue {
    std::variant<std::monostate, std::int64_t, std::uint64_t, double, std::string, std::vector<DecodedValue>,
                 std::vector<DecodedField>>
        content;
};

/// A named value. The name ends with the unit where there is one: "lat_deg", "h_acc_m".
struct DecodedField {
    std::string name;
    DecodedValue value;
};

/// One message.
struct DecodedMessage {
    std::string protocol;   ///< one of stream_kind_name()
    std::string id;         ///< as the protocol writes it: "01-07", "GNGGA", "1077", "0x1F03", "232", "4007"
    std::string name;       ///< "NAV-PVT", "GPS_INPUT"; empty when the message is not known
    std::size_t bytes = 0;  ///< of the whole frame
    std::vector<DecodedField> fields;
    Bytes payload;  ///< of messages that are not known, or whose payload is not as it should be
};

/// "ubx", "nmea", "rtcm3", "msp", "mavlink", "sbf", "noise", "command", "unicore", "can", "casic".
std::string_view stream_kind_name(StreamKind kind);

/// What a piece says. Frames of messages that are not known keep their payload; noise keeps its bytes.
DecodedMessage decode_piece(const StreamPiece& piece);

/// One JSON object, without line end: protocol, id, name, bytes, and fields (an object) or payload (hexadecimal).
/// Numbers have as many digits as the message gives them; values that are missing are null.
/// @param offset of the frame's first byte in the stream
std::string json_line(const DecodedMessage& message, std::uint64_t offset);
/// One line for people, without line end: "UBX NAV-PVT tow_s=… lat_deg=…". Values that are missing are "-".
std::string text_line(const DecodedMessage& message);

/// Text as a JSON string, quotes included. Bytes that are not ASCII are taken as ISO 8859-1.
std::string json_string(std::string_view text);

}  // namespace skyloop::inline receiver
