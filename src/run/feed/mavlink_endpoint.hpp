/// The UDP socket of a MavlinkComponent.
///
/// The folder feed is what runs hear from vehicles and simulators around them, on threads of their own: it turns what
/// they say into commands, and never makes the loop wait.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "base/core/result.hpp"
#include "run/feed/mavlink_component.hpp"

namespace skyloop::inline run {

/// Where MAVLink is spoken.
struct MavlinkAddress {
    bool speaks_first = false;  ///< "udpout": sends to this address; else listens at it
    std::string host = "127.0.0.1";
    std::uint16_t port = 14550;
};

/// "udp:[HOST:]PORT", "udpout:HOST:PORT", of IPv6 "udp:[::1]:14550". Fails with `usage`.
Result<MavlinkAddress> parse_mavlink_address(std::string_view text);

/// What an endpoint needs of the run.
struct MavlinkParts {
    std::vector<std::string> receivers;  ///< their names
    CommandSink push;                    ///< called by the endpoint's thread
    /// Starts its thread; empty: an ordinary one.
    std::function<std::thread(std::function<void()>)> thread{};
};

/// A MavlinkComponent on a thread of its own: a heartbeat each second to every peer that it has heard, or to the one it
/// was given. At most 8 peers, forgotten after 10 s of silence; datagrams above 2048 bytes are dropped; at most some
/// 6000 datagrams a second are taken, the rest is the kernel's to drop.
class MavlinkEndpoint {
public:
    /// Listens when it returns. Fails with `outside` when the address cannot be used.
    static Result<std::unique_ptr<MavlinkEndpoint>> start(const MavlinkAddress& address, MavlinkParts parts);
    virtual ~MavlinkEndpoint() = default;

    /// Own port, as the system gave it.
    [[nodiscard]] virtual std::uint16_t port() const = 0;
    /// "udp:127.0.0.1:14550 (system 245, component 191)"
    [[nodiscard]] virtual std::string description() const = 0;
};

}  // namespace skyloop::inline run
