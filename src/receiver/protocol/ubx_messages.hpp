/// The UBX messages that are known: their names, as u-blox's documents and tools write them (RECEIVER.md 2.3 and 3;
/// u-blox M8 and F9 interface descriptions), and their layouts.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "receiver/protocol/ubx_frame.hpp"

namespace skyloop::inline receiver {

struct DecodedField;

/// A message with its name: "NAV-PVT"; of the classes that CFG-MSG numbers the sentences of other protocols by, "GGA"
/// (F0), "PUBX-00" (F1) and "RTCM-1005" (F5).
struct UbxMessage {
    UbxMessageId id;
    std::string_view name;
    /// The fields of a payload that is not empty; nothing where it has none of the message's layouts. Null: none is
    /// known here.
    std::optional<std::vector<DecodedField>> (*list)(ByteSpan payload) = nullptr;
};

/// All that are known, ascending by id.
std::span<const UbxMessage> ubx_messages();

/// The name of a message, or nothing for one that no document names.
std::optional<std::string_view> ubx_message_name(UbxMessageId id);

/// The message of a name, written exactly so, or nothing.
std::optional<UbxMessageId> ubx_message_from_name(std::string_view name);

/// The name; of a message without one class and id in hexadecimal digits, "01-07".
std::string to_string(UbxMessageId id);

}  // namespace skyloop::inline receiver
