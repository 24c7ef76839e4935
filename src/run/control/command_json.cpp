#include "run/control/command_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <utility>

#include "detail/control_json.hpp"
#include "run/fault/command.hpp"

namespace skyloop::inline run {
namespace {

constexpr std::array<std::string_view, 8> parameter_type_names{"number", "whole_number", "flag",  "word",
                                                               "words",  "text",         "texts", "numbers"};

// What a member's name or a text may hold; a fault's name is a row of a table and a line of a log.
constexpr std::size_t longest_json_text = 1000, longest_json_list = 10000;

tl::unexpected<Error> json_mistake(std::string sentence) { return fail(ErrorCode::input, std::move(sentence)); }

bool is_plain_text(const std::string& text) {
    return text.size() <= longest_json_text &&
           std::none_of(text.begin(), text.end(), [](char c) { return (c >= 0 && c < ' ') || c == 0x7F; });
}

template <class Value>
std::optional<ParameterValue> list_value(const Json& list, bool (Json::*is)() const noexcept) {
    std::vector<Value> values;
    for (const Json& item : list) {
        if (!(item.*is)()) return std::nullopt;
        values.push_back(item.get<Value>());
    }
    return values;
}

std::optional<ParameterValue> value_of(const Json& value) {
    if (value.is_number()) return value.get<double>();
    if (value.is_boolean()) return value.get<bool>();
    if (value.is_string()) {
        auto text = value.get<std::string>();
        return is_plain_text(text) ? std::optional<ParameterValue>(std::move(text)) : std::nullopt;
    }
    if (!value.is_array() || value.size() > longest_json_list) return std::nullopt;
    if (value.empty() || value.front().is_number()) return list_value<double>(value, &Json::is_number);
    auto texts = list_value<std::string>(value, &Json::is_string);
    if (!texts) return std::nullopt;
    const auto& list = std::get<std::vector<std::string>>(*texts);
    return std::all_of(list.begin(), list.end(), is_plain_text) ? texts : std::nullopt;
}

// nlohmann/json keeps the last of members of one name; here that is a mistake.
struct TwiceGuard {
    std::set<std::string> names{};
    std::optional<std::string> twice{};
    bool operator()(int depth, Json::parse_event_t event, Json& parsed) {
        if (event == Json::parse_event_t::key && depth == 1 && !names.insert(parsed.get<std::string>()).second)
            twice = parsed.get<std::string>();
        return true;
    }
};

Result<Json> parsed_object(std::string_view text) {
    TwiceGuard guard;
    try {
        Json value = Json::parse(
            text.begin(), text.end(),
            [&guard](int depth, Json::parse_event_t event, Json& parsed) { return guard(depth, event, parsed); });
        if (guard.twice) return json_mistake(fmt::format("'{}' stands there twice", shown_name(*guard.twice)));
        if (!value.is_object())
            return json_mistake(fmt::format("the body is a JSON {}; expected an object", value.type_name()));
        return value;
    } catch (const Json::parse_error& error) {
        return json_mistake(
            fmt::format("the body is no JSON from byte {} on; expected an object of named values", error.byte));
    } catch (const Json::exception&) {
        return json_mistake("the body holds a number that is too large; expected an object of named values");
    }
}

Json choices_json(const ParameterSpec& spec) {
    return std::vector<std::string>(spec.choices.begin(), spec.choices.end());
}

// Null where there is none.
Json standard_json(const ParameterSpec& spec) {
    const auto standard = spec.standard_value();
    return standard ? to_json(*standard) : Json(nullptr);
}

}  // namespace

Result<ParameterMap> parameters_from_json(std::string_view text) {
    const Result<Json> object = parsed_object(text);
    if (!object) return fail(object.error());
    ParameterMap values;
    for (const auto& [name, member] : object->items()) {
        auto value = value_of(member);
        if (!value)
            return json_mistake(
                fmt::format("'{}' is a JSON {}; expected a number, true or false, a text of one line, or a list of "
                            "numbers or texts",
                            shown_name(name), member.type_name()));
        values.emplace(name, std::move(*value));
    }
    return values;
}

Json to_json(const ParameterValue& value) {
    return std::visit([](const auto& held) { return Json(held); }, value);
}

Json to_json(const ParameterSpec& spec) {
    Json json{{"name", spec.name},
              {"type", parameter_type_names[static_cast<std::size_t>(spec.type)]},
              {"meaning", spec.meaning},
              {"needed", spec.needed},
              {"standard", standard_json(spec)}};
    if (spec.least > -ParameterSpec::unlimited) json["least"] = spec.least;
    if (spec.most < ParameterSpec::unlimited) json["most"] = spec.most;
    if (!spec.choices.empty()) json["choices"] = choices_json(spec);
    if (spec.type == ParameterType::numbers) {
        json["count_least"] = spec.count_least;
        if (spec.count_most < ParameterSpec::any_count) json["count_most"] = spec.count_most;
    }
    return json;
}

Json schema_of(const ParameterSpec& spec) {
    Json item;
    switch (spec.type) {
        case ParameterType::number:
        case ParameterType::whole_number:
        case ParameterType::numbers:
            item["type"] = spec.type == ParameterType::whole_number ? "integer" : "number";
            if (spec.least > -ParameterSpec::unlimited) item["minimum"] = spec.least;
            if (spec.most < ParameterSpec::unlimited) item["maximum"] = spec.most;
            break;
        case ParameterType::flag:
            item["type"] = "boolean";
            break;
        default:
            item["type"] = "string";
            if (!spec.choices.empty()) item["enum"] = choices_json(spec);
    }
    Json schema = item;
    if (spec.type == ParameterType::numbers) {
        schema = {{"type", "array"}, {"items", item}, {"minItems", spec.count_least}};
        if (spec.count_most < ParameterSpec::any_count) schema["maxItems"] = spec.count_most;
    }
    if (spec.type == ParameterType::texts || spec.type == ParameterType::words)
        schema = {{"oneOf", Json::array({item, {{"type", "array"}, {"items", item}, {"minItems", spec.count_least}}})}};
    schema["description"] = spec.meaning;
    if (const Json standard = standard_json(spec); !standard.is_null()) schema["default"] = standard;
    return schema;
}

namespace {

Json parameters_json(const ParameterList& parameters) {
    return json_list(parameters, [](const ParameterSpec& spec) { return to_json(spec); });
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
    return json_text(json_list(fault_kinds(), [](const FaultKind& kind) -> Json {
        return {{"name", kind.name},
                {"layer", fault_layer_names[static_cast<std::size_t>(kind.layer)]},
                {"effect", kind.effect},
                {"cause", kind.cause},
                {"measuring_receivers_only", kind.measuring_receivers_only},
                {"parameters", parameters_json(kind.parameters)}};
    }));
}

std::string command_kinds_json() {
    return json_text(json_list(command_kinds(), [](const CommandKind& kind) -> Json {
        return {{"name", kind.name},
                {"meaning", kind.meaning},
                {"live_only", kind.live_only},
                {"of_receiver", kind.of_receiver},
                {"parameters", parameters_json(kind.parameters)}};
    }));
}

}  // namespace skyloop::inline run
