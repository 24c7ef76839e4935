/// Names that a user gives to messages and satellites: whether they can ever come true.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "world/gnss/satellite.hpp"

namespace skyloop {

/// Whether a message is one that a name means, in letters of any case: "CFG-VALSET", "CFG-*" for all that begin so,
/// "anything"; "setSBFOutput" for "sso". @param name of the message, as MessageSeen has it
bool is_message_named(std::string_view name, std::string_view wanted);

/// What is wrong with a name that no message can have, or nothing: "'NONSENSE' is no message; expected …". Sentences
/// are open to all: three letters, or a proprietary address.
std::optional<std::string> message_name_mistake(std::string_view wanted);

/// What is wrong with a satellite that its system does not have, or nothing.
std::optional<std::string> satellite_mistake(SatelliteId satellite);

}  // namespace skyloop
