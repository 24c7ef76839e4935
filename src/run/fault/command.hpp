/// What happens once in a run, whoever asks for it.
/// Commands and live faults from named values, whoever brings them: HTTP, a script, a live source of truth.
#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "run/fault/parameters.hpp"
#include "run/fault/timeline.hpp"

namespace skyloop::inline run {

/// The commands of this version.
enum class CommandVerb {
    start_fault,           ///< of `parameters`: kind, name, for_s …; or one of the scenario by its name
    stop_fault,            ///< by name; of all occurrences
    restart,               ///< the receiver's navigation: cold, warm, hot
    reboot,                ///< the receiver
    forget_configuration,  ///< of the receiver
    set_baud,              ///< of the receiver's first UART
    move_to,               ///< the vehicle's path is shifted so that it is there now
    pause,                 ///< live runs: time stands still, and so does the receiver
    resume,
    step,           ///< a paused run goes on by so many seconds
    speed,          ///< simulated seconds per second
    vehicle_state,  ///< what the vehicle's autopilot tells of itself, for triggers
    note,           ///< a text for the record
    stop            ///< the run ends
};

/// A command as it was given, checked.
struct Command {
    CommandVerb verb = CommandVerb::note;
    Parameters parameters{};
    std::vector<std::string> receivers{};  ///< names; of a live fault there may be several; none: all
    std::string source{};                  ///< "scenario", "http", "mavlink", silence_source: for the record

    [[nodiscard]] bool is_for(std::string_view receiver) const {
        return receivers.empty() || std::find(receivers.begin(), receivers.end(), receiver) != receivers.end();
    }
};

/// The source of a pause that lasts while live sources are silent, and of the resume behind it.
inline constexpr std::string_view silence_source = "silence";

/// A command that can be asked for.
struct CommandKind {
    CommandVerb verb = CommandVerb::note;
    std::string_view name{};     ///< "move_to"
    std::string_view meaning{};  ///< a sentence
    ParameterList parameters{};
    bool live_only = false;              ///< nothing in virtual time
    bool of_receiver = false;            ///< may be for one receiver alone
    const ReceiverNeed* need = nullptr;  ///< nothing comes of it at a receiver that lacks this
};
std::span<const CommandKind> command_kinds();
const CommandKind* find_command_kind(std::string_view name);
/// "move_to"
std::string_view command_name(CommandVerb verb);
/// Nothing comes of it in virtual time.
bool is_live_only(CommandVerb verb);
/// The first bytes of any name, for a message of one line: what does not print is a question mark.
std::string shown_name(std::string_view text);
/// The state that a command vehicle_state tells. @param before it; what the command does not name stays
VehicleState vehicle_state_of(const Parameters& parameters, VehicleState before = {});
/// The command that tells a state. @param source of it
Command vehicle_state_command(const VehicleState& vehicle, std::string_view source);
/// What is wrong with the place, `at`, to which a command moves the vehicle; nothing of others.
std::optional<std::string> place_mistake(const Command& command);

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

}  // namespace skyloop::inline run
