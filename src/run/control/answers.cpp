// What the server answers to each request, the files of the page among it.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>

#include "base/core/embedded_file.hpp"
#include "base/core/words.hpp"
#include "detail/control_json.hpp"
#include "run/control/command_json.hpp"
#include "run/control/control_request.hpp"
#include "run/control/status_json.hpp"
#include "run/emulator/director.hpp"
#include "run/fault/command.hpp"
#include "run/fault/fault_kind.hpp"

namespace skyloop::inline run {

/// Those of src/run/control/page, by name.
std::span<const EmbeddedFile> page_files();

namespace {

constexpr std::string_view live_fault_prefix = "/api/faults/";

ControlResponse json_response(std::string body, int status = 200) {
    ControlResponse response;
    response.status = status;
    response.body = std::move(body);
    response.headers.emplace_back("Cache-Control", "no-store");
    return response;
}

std::string_view page_content_type(std::string_view path) {
    constexpr std::array<std::pair<std::string_view, std::string_view>, 5> types{
        {{".html", "text/html; charset=utf-8"},
         {".js", "text/javascript; charset=utf-8"},
         {".css", "text/css; charset=utf-8"},
         {".svg", "image/svg+xml"},
         {".json", "application/json"}}};
    for (const auto& [ending, type] : types)
        if (path.ends_with(ending)) return type;
    return "application/octet-stream";
}

std::optional<ControlResponse> page_answer(std::string_view path) {
    if (path == "/") path = "/index.html";
    for (const EmbeddedFile& file : page_files()) {
        if (path != fmt::format("/{}", file.name)) continue;
        ControlResponse response;
        response.content_type = page_content_type(path);
        response.body = file.content;
        // Nothing from elsewhere, no script inside the text, in nobody's frame.
        response.headers = {{"Content-Security-Policy",
                             "default-src 'self'; img-src 'self' data: blob:; style-src 'self' 'unsafe-inline'; "
                             "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
                            {"Referrer-Policy", "no-referrer"},
                            {"Cache-Control", "no-cache"}};
        return response;
    }
    return std::nullopt;
}

// One that a client has just begun may not be in a snapshot yet.
bool has_fault(const ControlSources& sources, const std::string& name) {
    if (sources.started != nullptr && sources.started->contains(name)) return true;
    if (!sources.snapshot) return false;
    const auto& bars = sources.snapshot->timeline;
    return std::any_of(bars.begin(), bars.end(),
                       [&](const TimelineBar& bar) { return !bar.command && bar.name == name; });
}

// As the director will call it; what it is asked for by may be the name of another entry.
Command with_given_name(Command command, const ControlSources& sources) {
    if (!begins_new_fault(command)) return command;
    auto values = command.parameters.values();
    values["name"] = given_fault_name(command, sources);
    command.parameters = Parameters(std::move(values));
    return command;
}

// What nobody of this run would carry out.
std::optional<std::string> target_mistake(const Command& command, const ControlSources& sources) {
    const FaultKind* kind = find_fault_kind(command.parameters.text("kind"));
    if (kind != nullptr && kind->measuring_receivers_only && !sources.measuring)
        return fmt::format("'kind' is '{}', which spoils measurements; this run's model makes none", kind->name);
    const bool of_fault = command.verb == CommandVerb::start_fault || command.verb == CommandVerb::stop_fault;
    const std::string fault = of_fault ? command.parameters.text("fault") : std::string();
    if (!fault.empty() && sources.snapshot && !has_fault(sources, fault))
        return fmt::format("'fault' is '{}'; expected the name of a fault; GET /api/timeline lists them",
                           fault.substr(0, 60));
    return sources.receivers != nullptr ? receiver_mistake(command, *sources.receivers) : std::nullopt;
}

ControlResponse queued(const Result<Command>& command, const ControlSources& sources) {
    if (!command) return error_response(422, command.error().message);
    if (const auto mistake = target_mistake(*command, sources)) return error_response(422, *mistake);
    const std::string told = command_json(with_given_name(*command, sources));
    if (sources.push && sources.push(*command)) return json_response("{\"accepted\":" + told + "}", 202);
    return error_response(429, "too many commands wait already; expected fewer a second", {{"Retry-After", "1"}});
}

// "%41" is "A"; nothing for what is no such text.
std::optional<std::string> percent_decoded(std::string_view text) {
    const auto digit = [](char c) {
        if (c >= '0' && c <= '9') return c - '0';
        if (c >= 'a' && c <= 'f') return c - 'a' + 10;
        return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
    };
    std::string decoded;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            decoded += text[i];
            continue;
        }
        if (i + 2 >= text.size() || digit(text[i + 1]) < 0 || digit(text[i + 2]) < 0) return std::nullopt;
        decoded += static_cast<char>(digit(text[i + 1]) * 16 + digit(text[i + 2]));
        i += 2;
    }
    return decoded;
}

ControlResponse stop_fault(const ControlRequest& request, const ControlSources& sources) {
    const auto name = percent_decoded(request.path().substr(live_fault_prefix.size()));
    if (!name || name->empty())
        return error_response(400, "the path ends without the name of a fault; expected /api/faults/NAME");
    const bool known = has_fault(sources, *name);
    if (!known)
        return error_response(
            404, fmt::format("no fault is called '{}'; GET /api/timeline lists them", name->substr(0, 60)));
    Json json{{"command", "stop_fault"}, {"fault", *name}};
    return queued(command_from_json(json_text(json), "http"), sources);
}

std::optional<ControlResponse> wrong_content(const ControlRequest& request) {
    const std::string_view type = request.header("Content-Type").value_or("");
    if (lower_case(without_blanks(type.substr(0, type.find(';')))) == "application/json") return std::nullopt;
    return error_response(415, fmt::format("the body is '{}'; expected application/json", type));
}

ControlResponse get_answer(const ControlRequest& request, const ControlSources& sources) {
    const std::string_view path = request.path();
    if (path == "/api/faults") return json_response(fault_kinds_json());
    if (path == "/api/commands") return json_response(command_kinds_json());
    if (path == "/api/openapi.json") return json_response(openapi_json(sources.version));
    if (path == "/api/scene")
        return sources.scene != nullptr && !sources.scene->empty()
                   ? json_response(*sources.scene)
                   : error_response(404, "nothing stands around in this run: there is no scene");
    if (path == "/api/stream")
        return error_response(426, "a plain request; expected a WebSocket", {{"Upgrade", "websocket"}});
    if (!sources.snapshot) return error_response(503, "the run has not begun");
    if (path == "/api/timeline") return json_response(timeline_json(*sources.snapshot));
    return json_response(sources.status != nullptr ? *sources.status : recent_status_json(*sources.snapshot));
}

// The methods of a path below /api; empty: there is no such path.
std::string_view methods_of(std::string_view path) {
    if (path == "/api/commands" || path == "/api/faults") return "GET, HEAD, POST";
    for (const std::string_view known :
         {"/api/status", "/api/timeline", "/api/scene", "/api/openapi.json", "/api/stream"})
        if (path == known) return "GET, HEAD";
    return path.starts_with(live_fault_prefix) ? "DELETE" : "";
}

// @param words "GET, POST"
bool is_one_of(std::string_view word, std::string_view words) {
    return word.find(',') == std::string_view::npos &&
           fmt::format(", {},", words).find(fmt::format(", {},", word)) != std::string::npos;
}

ControlResponse api_answer(const ControlRequest& request, const ControlSources& sources) {
    const std::string_view methods = methods_of(request.path());
    if (methods.empty())
        return error_response(
            404, fmt::format("no path '{}'; GET /api/openapi.json lists them", request.path().substr(0, 200)));
    if (!is_one_of(request.method, methods))
        return error_response(405,
                              fmt::format("{} is not for {}; expected {}", request.method.substr(0, 20),
                                          request.path().substr(0, 200), methods),
                              {{"Allow", std::string(methods)}});
    if (request.method == "GET" || request.method == "HEAD") return get_answer(request, sources);
    if (request.method == "DELETE") return stop_fault(request, sources);
    if (auto wrong = wrong_content(request)) return std::move(*wrong);
    const auto read = request.path() == "/api/faults" ? live_fault_from_json : command_from_json;
    return queued(read(request.body, "http"), sources);
}

}  // namespace

std::string given_fault_name(const Command& command, const ControlSources& sources) {
    const auto is_taken = [&](const std::string& name) {
        if (has_fault(sources, name)) return true;
        if (!sources.snapshot) return false;
        const auto& bars = sources.snapshot->timeline;
        return std::any_of(bars.begin(), bars.end(), [&](const TimelineBar& bar) { return bar.name == name; });
    };
    return free_name(command.parameters.text("name"), is_taken);
}

ControlResponse answer(const ControlRequest& request, const AccessRules& rules, const ControlSources& sources) {
    if (auto refused = refusal(request, rules)) return std::move(*refused);
    if (request.body.size() > control_body_limit)
        return error_response(
            413, fmt::format("the body has {} bytes; expected at most {}", request.body.size(), control_body_limit));
    if (request.path().starts_with("/api/")) return api_answer(request, sources);
    if (request.method != "GET" && request.method != "HEAD")
        return error_response(405, "only GET is for the page", {{"Allow", "GET, HEAD"}});
    if (auto page = page_answer(request.path())) return std::move(*page);
    return error_response(404, fmt::format("no page '{}'; expected /", request.path().substr(0, 200)));
}

}  // namespace skyloop::inline run
