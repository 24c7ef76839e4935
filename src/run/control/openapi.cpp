// The description of the interface for programs, from the tables that also check it.
#include <utility>

#include "detail/control_json.hpp"
#include "run/control/command_json.hpp"
#include "run/control/control_request.hpp"
#include "run/control/status_json.hpp"
#include "run/fault/command.hpp"

namespace skyloop::inline run {
namespace {

Json json_answer(std::string_view description, std::string_view type = "application/json") {
    return {{"description", description}, {"content", {{type, {{"schema", Json::object()}}}}}};
}

Json error_answer(std::string_view description) {
    return {{"description", description},
            {"content", {{"application/json", {{"schema", {{"$ref", "#/components/schemas/Error"}}}}}}}};
}

// With what any request may be answered, whatever its path.
Json answers(const Json& own) {
    Json all{{"400", error_answer("no HTTP request, or none that names one host")},
             {"401", error_answer("no token, or a wrong one")},
             {"403", error_answer("from a page of another site")},
             {"421", error_answer("for a host that this is not")}};
    all.update(own);
    Json sorted = Json::object();
    for (const char* status :
         {"101", "200", "202", "400", "401", "403", "404", "413", "415", "421", "422", "426", "429", "503"})
        if (all.contains(status)) sorted[status] = all[status];
    return sorted;
}

Json described(std::string_view type, std::string_view meaning) { return {{"type", type}, {"description", meaning}}; }

Json described_or_null(std::string_view type, std::string_view meaning, Json more) {
    Json schema{{"type", Json::array({type, "null"})}, {"description", meaning}};
    schema.update(more);
    return schema;
}

Json baseline_schema() {
    Json vector{{"length_m", described("number", "metres")}};
    for (const char* part : {"north_m", "east_m", "down_m"})
        vector[part] = described("number", "metres, from the base to this antenna, along the base's own directions");
    vector["base_moves"] = described("boolean", "the base of a moving pair");
    vector["ratio"] = {{"type", {"number", "null"}},
                       {"description", "of the ambiguity test; null where none was passed"}};
    return described_or_null("object", "null while nothing of the base is in the solution", {{"properties", vector}});
}

Json corrections_schema() {
    Json place;
    for (const char* part : {"lat_deg", "lon_deg", "height_m"})
        place[part] = {{"type", "number"}};
    Json solution = described("string", "what of the corrections is in the reported solution");
    solution["enum"] = correction_words;
    return {
        {"type", "object"},
        {"description", "What the receiver has of a base; once corrections have come in"},
        {"properties",
         {{"solution", std::move(solution)},
          {"age_s", described("number", "age of the base's data, seconds; grows on without new ones")},
          {"station", described("integer", "number of the base, 0 to 4095")},
          {"base", described_or_null("object", "where it says it stands, right or wrong; height above the ellipsoid",
                                     {{"properties", std::move(place)}})},
          {"baseline", baseline_schema()}}},
        {"required", {"solution", "age_s", "station", "base", "baseline"}}};
}

// What is always there is not told here: it grows with the program.
Json status_schema() {
    const Json receiver{{"type", "object"},
                        {"properties", {{"corrections", {{"$ref", "#/components/schemas/Corrections"}}}}}};
    return {{"type", "object"}, {"properties", {{"receivers", {{"type", "array"}, {"items", receiver}}}}}};
}

Json reading(std::string_view summary, const Json& others = Json::object()) {
    Json own{{"200", json_answer(summary)}};
    own.update(others);
    return {{"get", {{"summary", summary}, {"responses", answers(own)}}}};
}

Json posting(std::string_view summary, std::string_view schema) {
    return {{"summary", summary},
            {"requestBody",
             {{"required", true},
              {"content",
               {{"application/json", {{"schema", {{"$ref", "#/components/schemas/" + std::string(schema)}}}}}}}}},
            {"responses", answers({{"202", json_answer("taken; the run carries it out at its next instant")},
                                   {"413", error_answer("more than 64 kB")},
                                   {"415", error_answer("not application/json")},
                                   {"422", error_answer("a mistake in it")},
                                   {"429", error_answer("too many commands wait")}})}};
}

// An object of these parameters, one of which tells the kind.
Json kind_schema(std::pair<std::string_view, std::string_view> told, std::string_view meaning,
                 std::span<const ParameterSpec> specs) {
    Json properties, needed = Json::array({told.first});
    properties[std::string(told.first)] = {{"const", told.second}};
    for (const ParameterSpec& spec : specs) {
        if (spec.name == told.first) continue;
        properties[spec.name] = schema_of(spec);
        if (spec.needed) needed.push_back(spec.name);
    }
    return {{"type", "object"},       {"title", told.second},
            {"description", meaning}, {"properties", std::move(properties)},
            {"required", needed},     {"additionalProperties", false}};
}

constexpr ParameterSpec receiver_parameter = text_parameter("receiver", "", "name of one receiver; empty: all");

Json commands_schema() {
    Json list = Json::array();
    for (const CommandKind& kind : command_kinds()) {
        std::vector<ParameterSpec> specs(kind.parameters.begin(), kind.parameters.end());
        if (kind.of_receiver) specs.push_back(receiver_parameter);
        list.push_back(kind_schema({"command", kind.name}, kind.meaning, specs));
    }
    return {{"oneOf", std::move(list)}};
}

Json faults_schema() {
    Json list = Json::array();
    for (const FaultKind& kind : fault_kinds()) {
        std::vector<ParameterSpec> specs(std::begin(live_fault_parameters), std::end(live_fault_parameters));
        specs.push_back(texts_parameter("receiver", "names of the receivers that it is for; none given: all"));
        specs.insert(specs.end(), kind.parameters.begin(), kind.parameters.end());
        list.push_back(kind_schema({"kind", kind.name}, fmt::format("{} {}", kind.effect, kind.cause), specs));
    }
    return {{"oneOf", std::move(list)}};
}

Json stream_path() {
    const Json rate{{"name", "rate"},
                    {"in", "query"},
                    {"description", "snapshots a second"},
                    {"schema", {{"type", "number"}, {"minimum", 1}, {"maximum", 10}, {"default", 2}}}};
    return {{"get",
             {{"summary", "A WebSocket: a snapshot as text, as often as asked for; lines of dialogue once each"},
              {"parameters", Json::array({rate})},
              {"responses", answers({{"101", {{"description", "snapshots follow"}}},
                                     {"400", error_answer("a rate that is no number from 1 to 10")},
                                     {"426", error_answer("no WebSocket")}})}}}};
}

Json fault_path() {
    const Json name{{"name", "name"}, {"in", "path"}, {"required", true}, {"schema", {{"type", "string"}}}};
    return {{"delete",
             {{"summary", "Ends a fault, all occurrences of it; its ramp out still runs"},
              {"parameters", Json::array({name})},
              {"responses", answers({{"202", json_answer("taken")},
                                     {"404", error_answer("no such fault")},
                                     {"429", error_answer("too many commands wait")}})}}}};
}

Json paths() {
    Json paths;
    const Json not_begun{{"503", error_answer("the run has not begun")}};
    paths["/api/status"] = reading("The last snapshot, at most a second old", not_begun);
    paths["/api/status"]["get"]["responses"]["200"]["content"]["application/json"]["schema"] = {
        {"$ref", "#/components/schemas/Status"}};
    paths["/api/timeline"] = reading("Faults and commands with their known times", not_begun);
    paths["/api/scene"] =
        reading("Roofs and trees around, from above", {{"404", error_answer("nothing stands around")}});
    paths["/api/openapi.json"] = reading("This description");
    paths["/api/commands"] = reading("Kinds of commands with their parameters");
    paths["/api/commands"]["post"] = posting("Gives a command", "Command");
    paths["/api/faults"] = reading("Kinds of faults with their parameters");
    paths["/api/faults"]["post"] = posting("Begins a fault now", "Fault");
    paths["/api/faults/{name}"] = fault_path();
    paths["/api/stream"] = stream_path();
    return paths;
}

}  // namespace

std::string openapi_json(std::string_view version) {
    const Json error{
        {"type", "object"}, {"properties", {{"error", {{"type", "string"}}}}}, {"required", Json::array({"error"})}};
    Json json{{"openapi", "3.1.0"}, {"info", {{"title", "skyloop control"}, {"version", version}}}};
    json["paths"] = paths();
    json["components"] = {{"schemas",
                           {{"Error", error},
                            {"Command", commands_schema()},
                            {"Fault", faults_schema()},
                            {"Status", status_schema()},
                            {"Corrections", corrections_schema()}}},
                          {"securitySchemes", {{"bearer", {{"type", "http"}, {"scheme", "bearer"}}}}}};
    json["security"] = Json::array({{{"bearer", Json::array()}}, Json::object()});
    return json_text(json);
}

}  // namespace skyloop::inline run
