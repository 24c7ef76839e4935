/// MAVLink's way to ask for failures, as faults of a run.
///
/// Units and types: FAILURE_UNIT and FAILURE_TYPE of MAVLink's common.xml; the command: MAV_CMD_INJECT_FAILURE there.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "receiver/protocol/mavlink.hpp"
#include "run/fault/command.hpp"

namespace skyloop {

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

}  // namespace skyloop
