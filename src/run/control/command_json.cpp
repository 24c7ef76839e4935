#include "run/control/command_json.hpp"

#include <fmt/format.h>

#include <utility>

#include "detail/parameter_json.hpp"
#include "run/fault/checked_command.hpp"

namespace skyloop {
namespace {

template <class Kind>
Json parameters_json(const Kind& kind) {
    Json list = Json::array();
    for (const ParameterSpec& spec : kind.parameters)
        list.push_back(to_json(spec));
    return list;
}

}  // namespace

Result<Command> live_fault_from_json(std::string_view text, std::string_view source) {
    auto members = parameters_from_json(text);
    if (!members) return fail(members.error());
    return checked_live_fault(std::move(*members), source);
}

Result<Command> command_from_json(std::string_view text, std::string_view source) {
    auto members = parameters_from_json(text);
    if (!members) return fail(members.error());
    return checked_command(std::move(*members), source);
}

std::string command_json(const Command& command) {
    Json json;
    json["command"] = command_name(command.verb);
    const std::vector<std::string>& receivers = command.receivers;
    if (!receivers.empty()) json["receiver"] = receivers.size() == 1 ? Json(receivers.front()) : Json(receivers);
    for (const auto& [name, value] : command.parameters.values())
        json[name] = to_json(value);
    return json_text(json);
}

std::string fault_kinds_json() {
    Json list = Json::array();
    for (const FaultKind& kind : fault_kinds())
        list.push_back({{"name", kind.name},
                        {"layer", fault_layer_names[static_cast<std::size_t>(kind.layer)]},
                        {"effect", kind.effect},
                        {"cause", kind.cause},
                        {"measuring_receivers_only", kind.measuring_receivers_only},
                        {"parameters", parameters_json(kind)}});
    return json_text(list);
}

std::string command_kinds_json() {
    Json list = Json::array();
    for (const CommandKind& kind : command_kinds())
        list.push_back({{"name", kind.name},
                        {"meaning", kind.meaning},
                        {"live_only", kind.live_only},
                        {"of_receiver", kind.of_receiver},
                        {"parameters", parameters_json(kind)}});
    return json_text(list);
}

}  // namespace skyloop
