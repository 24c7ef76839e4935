#include "run/fault/command.hpp"

#include <algorithm>
#include <utility>

#include "base/geo/geodetic.hpp"
#include "firmware/start_kind.hpp"

namespace skyloop {
namespace {

using Verb = CommandVerb;
constexpr bool live = true, of_receivers = true;

constexpr ParameterSpec start_parameter =
    word_parameter("start", "hot", firmware::start_kind_names, "what it still knows");

constexpr CommandKind kinds_of_commands[] = {
    {Verb::start_fault,
     "start_fault",
     "Begins a fault of the scenario now, by its name.",
     {text_parameter("fault", "", "name of a fault of the scenario"),
      number_parameter("for_s", no_standard, 0, 1e9, "how long; else as the scenario says")}},
    {Verb::stop_fault,
     "stop_fault",
     "Ends a fault now; its ramp out still runs.",
     {text_parameter("fault", "", "name of a fault; empty: all")}},
    {Verb::move_to,
     "move_to",
     "The vehicle is moved: its path goes on from there.",
     {place_parameter("at", "[latitude, longitude] or [latitude, longitude, height]").that_is_needed()}},
    // What is not given stays as it was told before.
    {Verb::vehicle_state,
     "vehicle_state",
     "What the vehicle's autopilot tells of itself, for triggers: of --mavlink, or by hand. What is not given stays "
     "as it was.",
     {text_parameter("mode", "", "name of its mode: \"AUTO\"").without_standard(),
      whole_number_parameter("custom_mode", no_standard, 0, 4294967295.0, "its number in HEARTBEAT"),
      flag_parameter("armed", false, "motors may turn").without_standard()}},
    {Verb::note, "note", "A text for the record.", {text_parameter("text", "", "what is to be written down")}},
    {Verb::stop, "stop", "The run ends.", {}},
    {Verb::restart,
     "restart",
     "The receiver's navigation starts anew, its configuration stays.",
     {start_parameter},
     !live,
     of_receivers},
    {Verb::reboot,
     "reboot",
     "The receiver starts anew as after a hardware reset: banner, stored speed.",
     {start_parameter},
     !live,
     of_receivers},
    {Verb::forget_configuration,
     "forget_configuration",
     "The receiver is as at the factory, its speed among it, and says nothing of it.",
     {},
     !live,
     of_receivers},
    {Verb::set_baud,
     "set_baud",
     "The receiver's first UART has another speed from now on.",
     {whole_number_parameter("baud", no_standard, 300, 12e6, "bit/s").that_is_needed()},
     !live,
     of_receivers},
    {Verb::pause, "pause", "Simulated time stands still.", {}, live},
    {Verb::resume, "resume", "Simulated time goes on.", {}, live},
    {Verb::step,
     "step",
     "A paused run goes on by so much.",
     {number_parameter("seconds", 1, 1e-3, 86400, "s of simulated time")},
     live},
    {Verb::speed,
     "speed",
     "Simulated seconds per second from now on.",
     {needed_number("factor", 1e-3, 1e6, "simulated seconds per second")},
     live}};

}  // namespace

std::span<const CommandKind> command_kinds() { return kinds_of_commands; }

const CommandKind* find_command_kind(std::string_view name) {
    const auto* const found = std::find_if(std::begin(kinds_of_commands), std::end(kinds_of_commands),
                                           [&](const CommandKind& kind) { return kind.name == name; });
    return found == std::end(kinds_of_commands) ? nullptr : found;
}

std::string_view command_name(CommandVerb verb) {
    for (const CommandKind& kind : command_kinds())
        if (kind.verb == verb) return kind.name;
    return "";
}

VehicleState vehicle_state_of(const Parameters& parameters, VehicleState before) {
    VehicleState vehicle = std::move(before);
    if (parameters.has("mode")) vehicle.mode = parameters.text("mode");
    if (const auto number = parameters.optional_number("custom_mode"))
        vehicle.custom_mode = static_cast<std::uint32_t>(*number);
    if (parameters.has("armed")) vehicle.armed = parameters.flag("armed");
    return vehicle;
}

Command vehicle_state_command(const VehicleState& vehicle, std::string_view source) {
    std::map<std::string, ParameterValue, std::less<>> values{{"mode", vehicle.mode}};
    if (vehicle.custom_mode) values["custom_mode"] = static_cast<double>(*vehicle.custom_mode);
    if (vehicle.armed) values["armed"] = *vehicle.armed;
    Command command;
    command.verb = CommandVerb::vehicle_state;
    command.parameters = Parameters(std::move(values));
    command.source = source;
    return command;
}

std::optional<std::string> place_mistake(const Command& command) {
    const std::vector<double> at = command.parameters.numbers("at");
    if (command.verb != CommandVerb::move_to || at.size() < 2) return std::nullopt;
    const auto place = place_from_degrees(at[0], at[1], at.size() > 2 ? at[2] : 0);
    return place ? std::nullopt : std::optional(place.error());
}

}  // namespace skyloop
