#include "run/fault/checked_command.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "base/core/spelling.hpp"
#include "run/fault/fault_kind.hpp"
#include "run/fault/timeline_keys.hpp"

namespace skyloop {
namespace {

// Any bytes as a piece of one line.
std::string shown_name(std::string_view text) {
    constexpr std::size_t longest = 60;
    std::string shown;
    for (const char c : text.substr(0, longest))
        shown += c >= ' ' && c != 0x7F ? c : '?';
    return shown;
}

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

}  // namespace skyloop
