/// Commands and live faults from named values, whoever brings them: HTTP, a script, a live source of truth.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "run/fault/command.hpp"
#include "run/fault/parameters.hpp"

namespace skyloop {

using ParameterMap = std::map<std::string, ParameterValue, std::less<>>;

/// The command of command_kinds() that the member "command" names, with the other members as its parameters and
/// "receiver" for which it is. A start_fault with a "kind" is one of checked_live_fault(). Fails with `input`: one line
/// that names the member, what was found and what was expected. @param source of the command
Result<Command> checked_command(ParameterMap members, std::string_view source);

/// The fault of the member "kind" that begins now, as the command start_fault with all of it as parameters; the kind's
/// own are checked and completed with their standards, and the fault is made once to see that they agree. Without a
/// name it is called as its kind.
Result<Command> checked_live_fault(ParameterMap members, std::string_view source);

/// The parameters that every live fault takes beside those of its kind: kind, name, for_s, ramp_in_s, ramp_out_s.
inline constexpr ParameterSpec live_fault_parameters[] = {
    text_parameter("kind", "", "kind of the fault"), text_parameter("name", "", "how it is called; empty: as its kind"),
    number_parameter("for_s", no_standard, 0, 1e9, "how long, s; else until it is stopped"),
    number_parameter("ramp_in_s", 0, 0, 1e9, "s in which it grows to its full strength"),
    number_parameter("ramp_out_s", 0, 0, 1e9, "s in which it fades after its end")};

/// What is wrong with the receiver that a command is for, or nothing: only the run knows who there is.
/// @param receivers names of those of the run
std::optional<std::string> receiver_mistake(const Command& command, std::span<const std::string> receivers);

/// All mistakes in one line: "'loss' is 7; expected …".
Error mistakes_error(const std::vector<ParameterMistake>& mistakes);

}  // namespace skyloop
