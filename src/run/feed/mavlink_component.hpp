/// skyloop as a component of a MAVLink network, without a socket.
///
/// Behaviour: the MAVLink developer guide, "Heartbeat/Connection Protocol" and "Command Protocol".
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/core/bytes.hpp"
#include "receiver/protocol/mavlink.hpp"
#include "run/fault/timeline.hpp"
#include "run/feed/failure_injection.hpp"

namespace skyloop {

/// Who skyloop is in a MAVLink network: a system of its own, MAV_COMP_ID_ONBOARD_COMPUTER of minimal.xml.
inline constexpr std::uint8_t mavlink_own_system = 245, mavlink_own_component = 191;

/// Follows the heartbeats of the first vehicle that it hears and takes commands that are for it; both become commands
/// of the run, with the source "mavlink".
///
/// State: the vehicle, what it was last told to be, and the failures that are injected.
class MavlinkComponent {
public:
    using Time = std::chrono::steady_clock::time_point;
    /// @param receivers names of the run's receivers @param push where commands go; called by hear() and look()
    MavlinkComponent(std::vector<std::string> receivers, const CommandSink& push);

    struct Heard {
        bool any = false;            ///< there was a whole frame: its sender speaks MAVLink
        std::vector<Bytes> answers;  ///< frames for the sender
    };
    /// Takes a datagram of any bytes.
    Heard hear(ByteSpan datagram, Time now);
    /// Tells the run what it could not be told before: at most one state of the vehicle in 50 ms.
    void look(Time now);
    /// The next frame that says that we are alive: an onboard controller that is no autopilot.
    Bytes heartbeat();

private:
    void follow(const MavlinkFrameView& frame);
    template <class CommandMessage>
    void obey(const MavlinkFrameView& frame, std::vector<Bytes>& answers, Time now);
    [[nodiscard]] MavlinkResult inject(float unit, float type, float instance, Time now);
    MavlinkSource next_source();

    FailureInjector injector_;
    CommandSink push_;
    std::optional<std::pair<std::uint8_t, std::uint8_t>> vehicle_;  // system and component that are followed
    VehicleState state_, told_;
    std::optional<Time> told_at_;
    Time injections_since_{};  // of the second whose injections are counted
    int injections_ = 0;
    std::uint8_t sequence_ = 0;
};

}  // namespace skyloop
