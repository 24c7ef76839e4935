#include "run/fault/command.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "base/core/words.hpp"
#include "base/geo/geodetic.hpp"
#include "firmware/core/firmware_faults.hpp"
#include "run/fault/fault_kind.hpp"
#include "run/fault/timeline_keys.hpp"

namespace skyloop::inline run {
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
     of_receivers,
     &command_input},
    {Verb::set_baud,
     "set_baud",
     "The receiver's first UART has another speed from now on.",
     {whole_number_parameter("baud", no_standard, 300, 12e6, "bit/s").that_is_needed()},
     !live,
     of_receivers,
     &wired_uart1},
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

bool is_live_only(CommandVerb verb) {
    const CommandKind* kind = find_command_kind(command_name(verb));
    return kind != nullptr && kind->live_only;
}

std::string shown_name(std::string_view text) {
    constexpr std::size_t longest = 60;
    std::string shown;
    for (const char c : text.substr(0, longest))
        shown += c >= ' ' && c != 0x7F ? c : '?';
    return shown;
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
    ParameterMap values{{"mode", vehicle.mode}};
    if (vehicle.custom_mode) values["custom_mode"] = static_cast<double>(*vehicle.custom_mode);
    if (vehicle.armed) values["armed"] = *vehicle.armed;
    return {CommandVerb::vehicle_state, Parameters(std::move(values)), {}, std::string(source)};
}

std::optional<std::string> place_mistake(const Command& command) {
    const std::vector<double> at = command.parameters.numbers("at");
    if (command.verb != CommandVerb::move_to || at.size() < 2) return std::nullopt;
    const auto place = place_from_degrees(at[0], at[1], at.size() > 2 ? at[2] : 0);
    return place ? std::nullopt : std::optional(place.error());
}

namespace {

template <class Kind>
std::string not_a_kind(std::string_view what, std::string_view name, std::span<const Kind> kinds) {
    std::vector<std::string_view> names;
    for (const Kind& kind : kinds)
        names.push_back(kind.name);
    return fmt::format("'{}' is '{}'; expected the name of a {}{}", what, shown_name(name), what,
                       did_you_mean(name, names));
}

// Takes a text out of the members; empty when it is not there.
Result<std::string> taken_text(ParameterMap& members, std::string_view name) {
    const auto found = members.find(name);
    if (found == members.end()) return std::string();
    const auto* text = std::get_if<std::string>(&found->second);
    if (text == nullptr) return fail(ErrorCode::input, fmt::format("'{}' is no text; expected a name", name));
    std::string taken = *text;
    members.erase(found);
    return taken;
}

// Whom it is for: a name, or a list of them; none where it is not there, or empty as forms send what is not chosen.
Result<std::vector<std::string>> taken_receivers(ParameterMap& members) {
    const auto found = members.find("receiver");
    if (found == members.end()) return std::vector<std::string>();
    const auto* text = std::get_if<std::string>(&found->second);
    const auto* texts = std::get_if<std::vector<std::string>>(&found->second);
    if (text == nullptr && (texts == nullptr || texts->empty()))
        return fail(ErrorCode::input, "'receiver' is no text; expected a name, or a list of names");
    std::vector<std::string> taken;
    if (texts != nullptr)
        taken = *texts;
    else if (!text->empty())
        taken = {*text};
    members.erase(found);
    return taken;
}

}  // namespace

Result<Command> checked_live_fault(ParameterMap members, std::string_view source) {
    Command command;
    command.verb = CommandVerb::start_fault;
    command.source = source;
    auto receivers = taken_receivers(members);
    if (!receivers) return fail(receivers.error());
    command.receivers = std::move(*receivers);
    auto name = taken_text(members, "kind");
    if (!name) return fail(name.error());
    if (name->empty()) return fail(ErrorCode::input, "'kind' is missing; expected the name of a kind of fault");
    const FaultKind* kind = find_fault_kind(*name);
    if (kind == nullptr) return fail(ErrorCode::input, not_a_kind<FaultKind>("kind", *name, fault_kinds()));

    std::vector<ParameterSpec> specs(std::begin(live_fault_parameters), std::end(live_fault_parameters));
    specs.insert(specs.end(), kind->parameters.begin(), kind->parameters.end());
    members.emplace("kind", *name);
    CheckedParameters checked = check_parameters(specs, members);
    if (const auto mistake = entry_name_mistake(checked.parameters.text("name"))) checked.mistakes.push_back(*mistake);
    if (!checked.mistakes.empty()) return fail(mistakes_error(checked.mistakes));
    if (const auto mistakes = ramp_mistakes(*kind, checked.parameters); !mistakes.empty())
        return fail(mistakes_error(mistakes));
    ParameterMap values = checked.parameters.values();
    if (checked.parameters.text("name").empty()) values["name"] = *name;
    command.parameters = Parameters(std::move(values));
    const auto made = kind->make(command.parameters, FaultContext{1, *name});
    if (!made) return fail(ErrorCode::input, made.error().message);
    return command;
}

Result<Command> checked_command(ParameterMap members, std::string_view source) {
    auto name = taken_text(members, "command");
    if (!name) return fail(name.error());
    if (name->empty()) return fail(ErrorCode::input, "'command' is missing; expected the name of a command");
    const CommandKind* kind = find_command_kind(*name);
    if (kind == nullptr) return fail(ErrorCode::input, not_a_kind<CommandKind>("command", *name, command_kinds()));
    if (kind->verb == CommandVerb::start_fault && members.contains("kind"))
        return checked_live_fault(std::move(members), source);

    Command command;
    command.verb = kind->verb;
    command.source = source;
    auto receivers = taken_receivers(members);
    if (!receivers) return fail(receivers.error());
    if (!receivers->empty() && !kind->of_receiver)
        return fail(ErrorCode::input, fmt::format("'receiver' is '{}'; expected none: {} is for the whole run",
                                                  shown_name(receivers->front()), kind->name));
    if (receivers->size() > 1)
        return fail(
            ErrorCode::input,
            fmt::format("'receiver' names {} receivers; expected one, or none for all of them", receivers->size()));
    command.receivers = std::move(*receivers);
    CheckedParameters checked = check_parameters(kind->parameters, members);
    if (!checked.mistakes.empty()) return fail(mistakes_error(checked.mistakes));
    if (kind->verb == CommandVerb::start_fault && checked.parameters.text("fault").empty())
        return fail(ErrorCode::input, "'fault' is missing; expected the name of a fault of the scenario, or 'kind'");
    command.parameters = std::move(checked.parameters);
    if (const auto mistake = place_mistake(command)) return fail(ErrorCode::input, "'at': " + *mistake);
    return command;
}

std::optional<std::string> receiver_mistake(const Command& command, std::span<const std::string> receivers) {
    for (const std::string& name : command.receivers)
        if (std::find(receivers.begin(), receivers.end(), name) == receivers.end())
            return fmt::format("'receiver' is '{}'; expected {}{}, or none for all of them", shown_name(name),
                               receivers.size() == 1 ? "" : "one of ", fmt::join(receivers, ", "));
    return std::nullopt;
}

Error mistakes_error(const std::vector<ParameterMistake>& mistakes) {
    Error error{ErrorCode::input, {}};
    for (const ParameterMistake& mistake : mistakes) {
        if (!error.message.empty()) error.message += "; ";
        if (!mistake.name.empty()) error.message += "'" + shown_name(mistake.name) + "' ";
        error.message += mistake.sentence;
    }
    return error;
}

}  // namespace skyloop::inline run
