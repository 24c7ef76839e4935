/// Names of messages, as board files write them.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "receiver/protocol/ubx_frame.hpp"

namespace skyloop::firmware {

/// A message that is answered, or that configures, but is never sent periodically.
struct NamedMessage {
    UbxMessageId id;
    std::string_view name;  ///< "MON-VER", "CFG-PRT"
};

/// What a client can poll beside what is sent periodically: MON-VER, SEC-UNIQID, the sentences that poll others, …
std::span<const NamedMessage> polled_messages();
/// The legacy messages of class CFG (M8 interface description, section 32.11).
std::span<const NamedMessage> legacy_messages();

}  // namespace skyloop::firmware
