/// The parts of the list of configuration items; `config_keys` puts them together.
#pragma once

#include <span>
#include <string_view>

#include "firmware/config/config_keys.hpp"

namespace skyloop::firmware {

/// Of what the navigation does: signals, filters, time pulse, corrections.
std::span<const ConfigKey> navigation_keys();
/// Of ports and of the protocols on them.
std::span<const ConfigKey> ports_keys();
/// Of texts, sentences, hardware, power and security.
std::span<const ConfigKey> system_keys();
/// Items that no document has: what legacy messages store besides. They are not on the wire.
std::span<const ConfigKey> private_keys();

/// A message and the middle of its items' names: "UBX_NAV_PVT" of CFG-MSGOUT-UBX_NAV_PVT_UART1.
struct RateKeys {
    OutputMessage message;
    std::string_view stem;
};
/// Ascending by message. A key of the group `private_message_group` is one of our own.
std::span<const RateKeys> rate_keys();

/// Groups that no interface description uses: rates of messages without a key, and what legacy messages store.
inline constexpr std::uint32_t private_message_group = 0xFE, private_item_group = 0xFD;

}  // namespace skyloop::firmware
