/// What happens once in a run, whoever asks for it.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "run/fault/parameters.hpp"
#include "run/fault/timeline.hpp"

namespace skyloop {

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
    bool live_only = false;    ///< nothing in virtual time
    bool of_receiver = false;  ///< may be for one receiver alone
};
std::span<const CommandKind> command_kinds();
const CommandKind* find_command_kind(std::string_view name);
/// "move_to"
std::string_view command_name(CommandVerb verb);
/// The state that a command vehicle_state tells. @param before it; what the command does not name stays
VehicleState vehicle_state_of(const Parameters& parameters, VehicleState before = {});
/// The command that tells a state. @param source of it
Command vehicle_state_command(const VehicleState& vehicle, std::string_view source);
/// What is wrong with the place, `at`, to which a command moves the vehicle; nothing of others.
std::optional<std::string> place_mistake(const Command& command);

}  // namespace skyloop
