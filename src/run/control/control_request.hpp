/// What a control request is answered, without a socket.
/// How HTTP compares what stands in headers.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "run/emulator/status_snapshot.hpp"
#include "run/fault/command.hpp"

namespace skyloop::inline run {

/// Without blanks and tabs at both ends.
inline std::string_view without_blanks(std::string_view text) {
    const std::size_t begin = std::min(text.find_first_not_of(" \t"), text.size());
    return text.substr(begin, text.find_last_not_of(" \t") + 1 - begin);
}

/// Bounds of what a client may send.
inline constexpr std::size_t control_body_limit = 64 * 1024, control_header_limit = 8 * 1024;

/// A request as HTTP has it. Names of headers are compared without regard to case.
struct ControlRequest {
    std::string method, target;  ///< "GET", "/api/status?pretty"
    std::vector<std::pair<std::string, std::string>> headers{};
    std::string body{};
    int version = 11;  ///< of HTTP: 11 for 1.1

    /// Empty when it is not there; nothing when it is there more than once.
    [[nodiscard]] std::optional<std::string_view> header(std::string_view name) const;
    /// A target with scheme and host, as proxies are asked, becomes a path, and its host the Host (RFC 9112, section
    /// 3.2.2).
    void take_absolute_form();
    /// The target before its '?'.
    [[nodiscard]] std::string_view path() const;
    /// The value of a key behind the '?', as it stands there; nothing when it is not there.
    [[nodiscard]] std::optional<std::string_view> query(std::string_view key) const;
};

using HeaderList = std::vector<std::pair<std::string, std::string>>;

struct ControlResponse {
    int status = 200;
    std::string content_type = "application/json";
    std::string body{};
    HeaderList headers{};
};

/// Who may ask.
struct AccessRules {
    std::string token{};   ///< that must be shown; empty: none
    std::string host{};    ///< the name or address that the server was told to listen at
    bool loopback = true;  ///< it is one of this machine alone
};

/// What requests are answered with.
struct ControlSources {
    std::shared_ptr<const StatusSnapshot> snapshot{};     ///< null: the run has not begun
    std::function<bool(Command)> push{};                  ///< false: too many wait; empty: nothing is taken
    const std::vector<std::string>* receivers = nullptr;  ///< names of those that a command may be for; null: any
    bool measuring = true;  ///< the receivers measure, so that faults of measurements have something to spoil
    /// Names of faults that clients have begun; null: none.
    const std::set<std::string, std::less<>>* started = nullptr;
    const std::string* status = nullptr;  ///< recent_status_json() where it has been made; else null
    const std::string* scene = nullptr;   ///< scene_json(); null: there is none
    std::string_view version{};           ///< of the program
};

/// {"error": "…"} with a status, in one line.
ControlResponse error_response(int status, std::string_view sentence, HeaderList headers = {});

/// Why a request is not answered, or nothing. The Host must be an address, "localhost" or the name that the server
/// listens at, on loopback one of loopback, so that no foreign name leads here (DNS rebinding); off loopback any
/// name for who shows the token, and for the page; an Origin must be this
/// server's own, so that no other site's page speaks to it; below /api the token must be shown, as a bearer or, of a
/// WebSocket, as the subprotocol "bearer.TOKEN".
std::optional<ControlResponse> refusal(const ControlRequest& request, const AccessRules& rules);

/// The answer to a request, refusals among it. It changes nothing but by `push`.
ControlResponse answer(const ControlRequest& request, const AccessRules& rules, const ControlSources& sources);

/// What the fault will be called that a command begins: the name that it was asked for by, with a number where another
/// entry of the run has it. @param command of begins_new_fault()
std::string given_fault_name(const Command& command, const ControlSources& sources);

/// The OpenAPI 3.1 description of all this, from the same tables.
std::string openapi_json(std::string_view version);

}  // namespace skyloop::inline run
