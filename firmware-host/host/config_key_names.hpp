/// Names of configuration keys in decoded messages: the receiver knows them, the protocol layer does not.
#pragma once

#include "receiver/protocol/decoded_message.hpp"

namespace skyloop::host {

/// Adds to CFG-VALSET and CFG-VALGET a `name` beside each `key` of `pairs`, and to CFG-VALGET and CFG-VALDEL the list
/// `names` after `keys`. A key that is not known has no name. Other messages stay as they are.
void name_config_keys(DecodedMessage& message);

}  // namespace skyloop::host
