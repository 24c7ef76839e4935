/// skyloop as a component of a MAVLink network, without a socket.
///
/// Behaviour: the MAVLink developer guide, "Heartbeat/Connection Protocol" and "Command Protocol".
///
/// MAVLink's way to ask for failures, as faults of a run.
///
/// Units and types: FAILURE_UNIT and FAILURE_TYPE of MAVLink's common.xml; the command: MAV_CMD_INJECT_FAILURE there.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/core/bytes.hpp"
#include "receiver/protocol/mavlink.hpp"
#include "run/fault/command.hpp"
#include "run/fault/timeline.hpp"

namespace skyloop::inline run {

inline constexpr std::uint16_t mavlink_inject_failure = 420;  ///< MAV_CMD_INJECT_FAILURE
inline constexpr int failure_unit_gps = 4;                    ///< FAILURE_UNIT_SENSOR_GPS

/// FAILURE_TYPE.
enum class FailureType { ok = 0, off, stuck, garbage, wrong, slow, delayed, intermittent };

/// The fault that a type of failure is: its kind and what differs from the kind's standards.
struct FailureFault {
    FailureType type;
    std::string_view word;  ///< "off"
    std::string_view kind;  ///< "receiver_silent"
    std::map<std::string, ParameterValue, std::less<>> parameters;
};
/// One for every type but ok, in their order.
const std::vector<FailureFault>& failure_faults();

/// Where commands of a run go; false: too many wait there.
using CommandSink = std::function<bool(Command)>;

/// Turns failures that are asked for into commands of the run. Each receiver has one failure at a time: a new one takes
/// the place of the one before, the same again changes nothing while it is under way and begins it again where it is
/// not.
///
/// State: which failure each receiver was given last.
class FailureInjector {
public:
    /// @param receivers their names, in the order of their instances
    FailureInjector(std::vector<std::string> receivers, CommandSink push);

    /// @param unit FAILURE_UNIT @param type FAILURE_TYPE @param instance 0: all receivers; n: the n-th
    /// @return unsupported for other units than GNSS and unknown types, denied for numbers that are none of these and
    /// receivers that are not there, temporarily_rejected when the run has too much to do
    MavlinkResult inject(float unit, float type, float instance);

private:
    struct Injected {
        FailureType type = FailureType::ok;
        std::string name;  // of the fault
    };
    bool keep(std::size_t receiver);
    bool stop(std::size_t receiver);
    bool tell(CommandVerb verb, const std::string& fault);
    bool start(std::size_t receiver, const FailureFault& fault);

    std::vector<std::string> receivers_;
    std::vector<Injected> injected_;  // of each receiver
    CommandSink push_;
    int started_ = 0;
};

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

}  // namespace skyloop::inline run
