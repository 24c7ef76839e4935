/// Commands of Septentrio's command line as messages of a client.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace skyloop {

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

}  // namespace skyloop
