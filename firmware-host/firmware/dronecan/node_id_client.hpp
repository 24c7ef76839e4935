/// How a node without an id gets one: the allocatee of uavcan.protocol.dynamic_node_id.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "base/core/random.hpp"
#include "base/time/gps_time.hpp"
#include "receiver/protocol/dronecan_messages.hpp"

namespace skyloop::firmware {

/// What tells one node from all others.
using NodeUniqueId = std::array<std::uint8_t, 16>;

/// Asks every 600 to 1000 ms with the first six bytes of the unique id. Once a server has repeated what it was told the
/// next six, or the last four, follow within 400 ms (dronecan.github.io, specification 6.5; DSDL
/// uavcan/protocol/dynamic_node_id/1.Allocation).
///
/// State: the id, when it asks next, and how much a server has repeated.
class NodeIdClient {
public:
    /// @param seed of its pauses
    NodeIdClient(const NodeUniqueId& unique_id, std::uint64_t seed);

    /// @param fixed an id that it need not ask for; 0: none
    void begin(GpsTime awake, std::uint8_t fixed);
    /// 0: none yet.
    [[nodiscard]] std::uint8_t id() const { return id_; }
    /// When request() is due.
    [[nodiscard]] std::optional<GpsTime> asks_at() const { return asks_at_; }
    /// What is asked then.
    DronecanAllocation request(GpsTime now);
    /// Any Allocation that another node sends. @param source of it; 0: another one that asks
    void receive(const DronecanAllocation& message, std::uint8_t source, GpsTime now);

private:
    void ask_anew(GpsTime now);
    [[nodiscard]] GpsTime later(GpsTime now, double least_s, double most_s);

    NodeUniqueId unique_id_;
    RandomStream pauses_;
    std::uint8_t id_ = 0;
    std::optional<GpsTime> asks_at_;
    std::size_t repeated_ = 0;  ///< bytes of the unique id that a server has
};

}  // namespace skyloop::firmware
