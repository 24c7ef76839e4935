/// UBX messages from field lists: encode_payload(), decode_payload() and wire_size() of field_list.hpp, and the frame.
#pragma once

#include "receiver/protocol/field_list.hpp"
#include "receiver/protocol/ubx_frame.hpp"

namespace skyloop::inline receiver {

/// The most that a U1 counts; longer lists are written up to here.
inline constexpr std::size_t ubx_most_items = most_items;

/// The whole frame of a message.
template <class Message>
Bytes encode_frame(const Message& message) {
    return encode_frame(Message::message_id, encode_payload(message));
}

}  // namespace skyloop::inline receiver
