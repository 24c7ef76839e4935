/// Commands and faults as JSON, both ways.
#pragma once

#include <string>
#include <string_view>

#include "base/core/result.hpp"
#include "run/fault/command.hpp"
#include "run/fault/fault_kind.hpp"

namespace skyloop::inline run {

/// {"command": "set_baud", "baud": 9600, "receiver": "front"}: a command of command_kinds(), checked. A start_fault
/// with a "kind" is one of live_fault_from_json(). Fails with `input`: one line that names the member, what was found
/// and what was expected. @param source of the command
Result<Command> command_from_json(std::string_view text, std::string_view source);

/// {"kind": "byte_loss", "name": "wet plug", "for_s": 20, "ramp_in_s": 2, …}: a fault that begins now, as the command
/// start_fault with all of it as parameters; the kind's own are checked and completed with their standards, and the
/// fault is made once to see that they agree. Without a name it is called as its kind.
Result<Command> live_fault_from_json(std::string_view text, std::string_view source);

/// {"command": …, "receiver": …, parameters…}: command_from_json() gives the same command again.
std::string command_json(const Command& command);

/// [{"name", "layer", "effect", "cause", "parameters": [{"name", "type", "meaning", …}]}]
std::string fault_kinds_json();
std::string command_kinds_json();

}  // namespace skyloop::inline run
