// The other end of --control on the command line.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>

#include "base/core/json.hpp"
#include "base/core/number_text.hpp"
#include "base/core/words.hpp"
#include "commands.hpp"
#include "messages.hpp"
#include "run/control/control_client.hpp"
#include "run/fault/command.hpp"

namespace skyloop::host {
namespace {

struct CtlOptions {
    std::string token;
    bool json = false;
    std::vector<std::string> words{};  // address, command and what belongs to it
};

constexpr std::string_view ctl_usage =
    "skyloop ctl [HOST:]PORT COMMAND …, COMMAND one of:\n"
    "  status | watch                the run now, or line after line\n"
    "  faults | commands             what can be asked for\n"
    "  fault KIND [KEY=VALUE…]       begins a fault: fault byte_loss for_s=20\n"
    "  stop NAME                     ends a fault\n"
    "  pause | resume | step [S] | speed X\n"
    "  move LAT,LON[,HEIGHT]         degrees, metres above the ellipsoid\n"
    "  end                           ends the run\n"
    "  any other of the commands, with KEY=VALUE…: set_baud baud=9600 receiver=front";

Json ctl_scalar(std::string_view text) {
    if (text == "true" || text == "false") return text == "true";
    if (const auto number = number_in<double>(text)) return *number;
    return text;
}

// "1,2" is a list, "a,b" too; the program at the other end knows what it wanted.
template <class OneValue>
Json ctl_value(std::string_view text, OneValue one) {
    if (text.find(',') == std::string_view::npos) return one(text);
    Json list = Json::array();
    while (true) {
        const std::size_t comma = text.find(',');
        list.push_back(one(text.substr(0, comma)));
        if (comma == std::string_view::npos) return list;
        text.remove_prefix(comma + 1);
    }
}

// Names are texts, whatever they look like.
Json ctl_pair_value(std::string_view key, std::string_view text) {
    const auto name = [](std::string_view one) { return Json(one); };
    if (key == "name" || key == "fault" || key == "text") return name(text);
    return key == "receiver" ? ctl_value(text, name) : ctl_value(text, ctl_scalar);
}

Result<Json> with_pairs(Json body, std::span<const std::string> pairs) {
    for (const std::string& pair : pairs) {
        const std::size_t equals = pair.find('=');
        if (equals == std::string::npos || equals == 0)
            return fail(ErrorCode::usage, fmt::format("'{}' is no parameter; expected KEY=VALUE", pair));
        const std::string key = pair.substr(0, equals);
        if (body.contains(key)) return fail(ErrorCode::usage, fmt::format("'{}' stands there twice", key));
        body[key] = ctl_pair_value(key, std::string_view(pair).substr(equals + 1));
    }
    return body;
}

std::string percent_encoded(std::string_view text) {
    std::string encoded;
    for (const char c : text) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
                           c == '-' || c == '.';
        encoded += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
    return encoded;
}

ControlRequest ctl_get(std::string path) { return {"GET", std::move(path), {}, {}}; }
ControlRequest ctl_post(std::string path, const Json& body) { return {"POST", std::move(path), {}, json_text(body)}; }

Result<ControlRequest> command_post(Json body, std::span<const std::string> pairs) {
    const auto whole = with_pairs(std::move(body), pairs);
    if (!whole) return fail(whole.error());
    return ctl_post("/api/commands", *whole);
}

Result<ControlRequest> number_post(const char* command, const char* key, const std::string& text) {
    const auto number = number_in<double>(text);
    if (!number) return fail(ErrorCode::usage, fmt::format("{}: '{}' is no number", command, text));
    return ctl_post("/api/commands", {{"command", command}, {key, *number}});
}

// What stands behind the commands that are ctl's own.
constexpr std::array<std::pair<std::string_view, std::string_view>, 8> ctl_shapes{{{"status", ""},
                                                                                   {"watch", ""},
                                                                                   {"faults", ""},
                                                                                   {"commands", ""},
                                                                                   {"fault", " KIND [KEY=VALUE…]"},
                                                                                   {"stop", " NAME"},
                                                                                   {"move", " LAT,LON[,HEIGHT]"},
                                                                                   {"end", ""}}};

// The command is known, and has other words behind it than it takes; or it is not.
Result<ControlRequest> misused_ctl_command(const std::string& word, std::size_t behind) {
    std::vector<std::string_view> names{"pause", "resume", "step", "speed"};
    for (const auto& [name, shape] : ctl_shapes) {
        names.push_back(name);
        if (name == word)
            return fail(ErrorCode::usage, fmt::format("ctl: '{}' has {} word{} behind it; expected: {}{}", word, behind,
                                                      behind == 1 ? "" : "s", name, shape));
    }
    for (const CommandKind& kind : command_kinds())
        names.push_back(kind.name);
    return fail(ErrorCode::usage,
                fmt::format("ctl: unknown command '{}'{}; see skyloop ctl --help", word, did_you_mean(word, names)));
}

// What a command line asks for, but `watch`.
Result<ControlRequest> ctl_request(std::span<const std::string> words) {
    const std::string& word = words.front();
    const auto rest = words.subspan(1);
    const auto wants = [&](std::size_t least, std::size_t most) { return rest.size() >= least && rest.size() <= most; };
    if ((word == "status" || word == "faults" || word == "commands") && wants(0, 0)) return ctl_get("/api/" + word);
    if (word == "fault" && !rest.empty()) {
        auto body = with_pairs({{"kind", rest[0]}}, rest.subspan(1));
        if (!body) return fail(body.error());
        return ctl_post("/api/faults", *body);
    }
    if (word == "stop" && wants(1, 1))
        return ControlRequest{"DELETE", "/api/faults/" + percent_encoded(rest[0]), {}, {}};
    if (word == "end" && wants(0, 0)) return ctl_post("/api/commands", {{"command", "stop"}});
    if (word == "step" && wants(1, 1) && rest[0].find('=') == std::string::npos)
        return number_post("step", "seconds", rest[0]);
    if (word == "speed" && wants(1, 1) && rest[0].find('=') == std::string::npos)
        return number_post("speed", "factor", rest[0]);
    if (word == "move" && wants(1, 1))
        return ctl_post("/api/commands", {{"command", "move_to"}, {"at", ctl_value(rest[0], ctl_scalar)}});
    if (word != "stop" && find_command_kind(word) != nullptr) return command_post({{"command", word}}, rest);
    return misused_ctl_command(word, rest.size());
}

std::string number_text(const Json& json, std::string_view format) {
    return json.is_number() ? fmt::format(fmt::runtime(format), json.get<double>()) : std::string("-");
}

std::string corrections_text(const Json& corrections) {
    std::string text =
        fmt::format("; corrections of base {}: {}, {} s old", corrections.at("station").get<int>(),
                    corrections.at("solution").get<std::string>(), number_text(corrections.at("age_s"), "{:.1f}"));
    if (const Json& baseline = corrections.at("baseline"); baseline.is_object())
        text += fmt::format(", baseline {} m", number_text(baseline.at("length_m"), "{:.3f}"));
    return text;
}

std::string receiver_text(const Json& receiver) {
    const Json& fix = receiver.at("fix");
    std::string text = fmt::format("{}: {}, {} satellites", receiver.at("name").get<std::string>(),
                                   fix.at("type").get<std::string>(), fix.at("satellites_used").get<int>());
    if (const Json& error = receiver.at("error"); error.is_object())
        text += fmt::format(", off by {} m east {} m north {} m up", number_text(error.at("east_m"), "{:+.1f}"),
                            number_text(error.at("north_m"), "{:+.1f}"), number_text(error.at("up_m"), "{:+.1f}"));
    if (receiver.contains("corrections")) text += corrections_text(receiver.at("corrections"));
    for (const Json& wire : receiver.at("wires"))
        text += fmt::format("; {} {} {} B out {} B in {} lost", wire.at("port").get<std::string>(),
                            number_text(wire.at("baud"), "{:.0f}"), wire.at("bytes_out").get<std::uint64_t>(),
                            wire.at("bytes_in").get<std::uint64_t>(), wire.at("bytes_lost").get<std::uint64_t>());
    return text;
}

std::string status_text(const Json& status, std::string_view separator) {
    std::string text =
        fmt::format("{} ({} s){}", status.at("time_utc").get<std::string>(),
                    number_text(status.at("elapsed_s"), "{:.1f}"), status.at("paused").get<bool>() ? " paused" : "");
    for (const Json& receiver : status.at("receivers"))
        text += std::string(separator) + receiver_text(receiver);
    for (const Json& bar : status.at("timeline"))
        if (bar.at("active").get<bool>())
            text += fmt::format("{}fault {} ({})", separator, bar.at("name").get<std::string>(),
                                bar.at("kind").get<std::string>());
    return text;
}

void print_kinds(const Json& kinds) {
    for (const Json& kind : kinds) {
        const std::string meaning = kind.value(kind.contains("effect") ? "effect" : "meaning", "");
        fmt::print("{:<24} {}\n", kind.at("name").get<std::string>(), meaning);
        for (const Json& one : kind.at("parameters"))
            fmt::print("    {:<20} {}{}\n", one.at("name").get<std::string>(), one.at("meaning").get<std::string>(),
                       one.at("needed").get<bool>() ? " (needed)" : "");
    }
}

void print_answer(const CtlOptions& options, const ControlResponse& response) {
    const Json json = Json::parse(response.body);
    if (options.json)
        fmt::print("{}\n", response.body);
    else if (options.words[1] == "status")
        fmt::print("{}\n", status_text(json, "\n  "));
    else if (json.is_array())
        print_kinds(json);
    else if (const Json accepted = json.value("accepted", Json::object()); accepted.contains("kind"))
        fmt::print("accepted as {}\n", accepted.at("name").get<std::string>());
    else
        fmt::print("accepted\n");
}

// What the server says to programs, in words of this command.
std::string ctl_sentence(std::string sentence, const ControlResponse& response, const std::string& port) {
    if (response.status == 401)
        return "the run wants another token, or one at all; expected --token TOKEN, or SKYLOOP_TOKEN in the "
               "environment, "
               "as the run's line 'control:' tells it";
    constexpr std::string_view asked = "GET /api/timeline lists them";
    if (const std::size_t at = sentence.find(asked); at != std::string::npos)
        sentence.replace(at, asked.size(), fmt::format("skyloop ctl {} status tells those under way", port));
    return sentence;
}

// 429 and what begins with 5 are the other end's; other refusals are the user's.
Error refused_answer(const ControlResponse& response, const std::string& port) {
    const Json json = Json::parse(response.body, nullptr, false);
    const bool told = json.is_object() && json.contains("error") && json.at("error").is_string();
    const bool outside = response.status == 429 || response.status >= 500;
    return {outside ? ErrorCode::outside : ErrorCode::usage,
            ctl_sentence(
                told ? json.at("error").get<std::string>() : fmt::format("refused with status {}", response.status),
                response, port)};
}

int watch_run(const CtlOptions& options, const ControlClient& client, const Messages& messages) {
    // A stream tells a refusal in words for programs.
    const auto asked = client.ask(ctl_get("/api/status"));
    if (asked && asked->status == 401) return messages.error(refused_answer(*asked, options.words[0]));
    const auto watched = client.watch(1, [&](std::string_view text) {
        fmt::print("{}\n", options.json ? std::string(text) : status_text(Json::parse(text), " | "));
        return std::fflush(stdout) == 0;
    });
    return watched ? 0 : messages.error(watched.error());
}

int ask_run(const CtlOptions& options, const ControlClient& client, const Messages& messages) {
    const auto request = ctl_request(std::span(options.words).subspan(1));
    if (!request) return messages.error(request.error());
    const auto response = client.ask(*request);
    if (!response) return messages.error(response.error());
    if (response->status >= 300) return messages.error(refused_answer(*response, options.words[0]));
    print_answer(options, *response);
    return 0;
}

int control_run(const CtlOptions& options) {
    const Messages messages(Verbosity{});
    if (options.words.size() < 2)
        return messages.error({ErrorCode::usage, "ctl: expected [HOST:]PORT and a command; see skyloop ctl --help"});
    for (const std::string& word : options.words)
        if (word.starts_with("--"))
            return messages.error({ErrorCode::usage, fmt::format("ctl: unknown option '{}'", word)});
    auto address = parse_control_address(options.words[0]);
    if (!address) return messages.error(address.error());
    address->token = options.token;
    const ControlClient client(*address);
    try {
        const bool watch = options.words[1] == "watch" && options.words.size() == 2;
        return watch ? watch_run(options, client, messages) : ask_run(options, client, messages);
    } catch (const Json::exception& error) {
        return messages.error(
            {ErrorCode::outside, fmt::format("the answer is not one of skyloop's: {}", error.what())});
    }
}

}  // namespace

Action add_ctl_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("ctl", "Commands to a running emulator at its control port");
    auto options = std::make_shared<CtlOptions>();
    command->add_option("--token", options->token, "What the port wants shown (or SKYLOOP_TOKEN)")
        ->envname("SKYLOOP_TOKEN");
    command->add_flag("--json", options->json, "Answers as JSON, one a line");
    command->footer(std::string(ctl_usage));
    command->allow_extras();  // a latitude may begin with '-'
    return [options, command] {
        options->words = command->remaining();
        return control_run(*options);
    };
}

}  // namespace skyloop::host
