/// Names that a user gives to messages and satellites: whether they can ever come true.
/// Commands of Septentrio's command line as messages of a client.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "world/gnss/satellite.hpp"

namespace skyloop::inline run {

/// The mnemonic of a command by either of its names, in letters of any case: "sso" for "setSBFOutput". Nothing for what
/// is no command.
std::optional<std::string_view> command_mnemonic(std::string_view word);

/// What a line of a client is called: the mnemonic of its command, SSSSSSSSSS for the ten and more that take a port
/// back for commands, the first word of what is no command. Nothing for an empty line and a comment.
std::optional<std::string> command_line_name(std::string_view line);

/// Whether a name of some command begins so. @param prefix in large letters
bool begins_some_command(std::string_view prefix);

/// Whether a command changes what is set: `set…` with all its names, and the copies of whole configurations.
bool is_setting_command(std::string_view mnemonic);

/// Whether a message is one that a name means, in letters of any case: "CFG-VALSET", "CFG-*" for all that begin so,
/// "anything"; "setSBFOutput" for "sso". @param name of the message, as MessageSeen has it
bool is_message_named(std::string_view name, std::string_view wanted);

/// What is wrong with a name that no message can have, or nothing: "'NONSENSE' is no message; expected …". Sentences
/// are open to all: three letters, or a proprietary address.
std::optional<std::string> message_name_mistake(std::string_view wanted);

/// What is wrong with a satellite that its system does not have, or nothing.
std::optional<std::string> satellite_mistake(SatelliteId satellite);

}  // namespace skyloop::inline run
