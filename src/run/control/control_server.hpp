/// HTTP and WebSocket: a run watched and steered from outside.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "run/emulator/command_queue.hpp"
#include "run/emulator/status_board.hpp"

namespace skyloop::inline run {

/// Where to listen, and to whom.
struct ControlOptions {
    std::string host = "127.0.0.1";  ///< a name or an address
    std::uint16_t port = 0;          ///< 0: any that is free
    std::string token{};             ///< that clients must show; empty: none on loopback, elsewhere one made at random
};

/// "[HOST:]PORT": "8080", "0.0.0.0:8080", "[::1]:8080". Fails with `usage`.
Result<ControlOptions> parse_control_address(std::string_view text);

/// What the server works with; both outlive it.
struct ControlParts {
    CommandQueue& commands;
    const StatusBoard& board;
    std::string scene{};                   ///< scene_json(); empty: there is none
    std::string version{};                 ///< of the program
    std::vector<std::string> receivers{};  ///< names of those that a command may be for
    bool measuring = true;                 ///< they measure; not with a sensor model
};

/// A server on a thread of its own, which never makes the loop wait. At most 16 clients at once; a request has at most
/// 8 kB of headers and 64 kB of body and 10 s to come; a WebSocket that does not read loses snapshots.
class ControlServer {
public:
    /// Listens when it returns. Fails with `usage` for a token with characters that a header cannot have, with
    /// `outside` when the address cannot be listened at.
    static Result<std::unique_ptr<ControlServer>> start(const ControlOptions& options, const ControlParts& parts);
    /// Hangs up on everybody.
    ~ControlServer();
    ControlServer(const ControlServer&) = delete;
    ControlServer& operator=(const ControlServer&) = delete;

    [[nodiscard]] std::uint16_t port() const;
    /// That clients must show; empty: none.
    [[nodiscard]] const std::string& token() const;
    /// What to open in a browser: "http://127.0.0.1:8080/", with "#token=…" when there is one.
    [[nodiscard]] std::string url() const;

private:
    class Impl;
    explicit ControlServer(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace skyloop::inline run
