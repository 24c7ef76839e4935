/// The fields of one message of each protocol; decode_piece() puts them together.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "base/core/bytes.hpp"
#include "receiver/protocol/decoded_message.hpp"
#include "receiver/protocol/field_lister.hpp"
#include "receiver/protocol/nmea_sentence.hpp"
#include "receiver/protocol/ubx_frame.hpp"

namespace skyloop {

/// How a UBX message with a known layout is listed.
struct UbxListing {
    UbxMessageId id;
    /// The message's fields; nothing when the payload is not of this layout.
    std::optional<std::vector<DecodedField>> (*list)(ByteSpan payload);
    bool (*names_fit)();  ///< as many names as fields
};

/// All of them. A message with several layouts stands there several times; the first that fits holds.
std::span<const UbxListing> ubx_listings();

/// Fills fields or payload of a message whose protocol and size are set.
void list_ubx(const UbxFrameView& frame, DecodedMessage& message);
void list_nmea(const SentenceView& sentence, DecodedMessage& message);
/// @param payload between length and CRC
void list_rtcm3(ByteSpan payload, DecodedMessage& message);

}  // namespace skyloop
