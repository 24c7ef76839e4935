#include "run/feed/failure_injection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "run/fault/checked_command.hpp"

namespace skyloop {
namespace {

// A whole number that a float of a command holds; nothing for NaN, infinities, fractions and what no enum has.
std::optional<int> whole_number(float value) {
    constexpr float largest = 65535;
    if (!(value >= 0 && value <= largest) || value != std::floor(value)) return std::nullopt;
    return static_cast<int>(value);
}

const FailureFault* find_failure(int type) {
    const auto& all = failure_faults();
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const FailureFault& f) { return static_cast<int>(f.type) == type; });
    return found == all.end() ? nullptr : &*found;
}

}  // namespace

// What each type means by common.xml, and what a receiver does then.
const std::vector<FailureFault>& failure_faults() {
    static const std::vector<FailureFault> faults{
        {FailureType::off, "off", "receiver_silent", {}},
        {FailureType::stuck, "stuck", "freeze", {}},
        // Half of all bits inverted: nothing is left of what was sent.
        {FailureType::garbage, "garbage", "bit_flips", {{"probability", 0.5}}},
        {FailureType::wrong, "wrong", "position_step", {{"north_m", 100.0}}},
        {FailureType::slow, "slow", "dropped_epochs", {{"probability", 0.8}}},
        {FailureType::delayed, "delayed", "solution_latency", {{"delay_s", 1.0}}},
        {FailureType::intermittent, "intermittent", "stall", {{"hold_s", 3.0}, {"period_s", 6.0}}}};
    return faults;
}

FailureInjector::FailureInjector(std::vector<std::string> receivers, CommandSink push)
    : receivers_(std::move(receivers)), injected_(receivers_.size()), push_(std::move(push)) {}

MavlinkResult FailureInjector::inject(float unit, float type, float instance) {
    const auto which_unit = whole_number(unit), which_type = whole_number(type), which = whole_number(instance);
    if (!which_unit || !which_type || !which) return MavlinkResult::denied;
    if (*which_unit != failure_unit_gps) return MavlinkResult::unsupported;
    const FailureFault* fault = find_failure(*which_type);
    if (fault == nullptr && *which_type != static_cast<int>(FailureType::ok)) return MavlinkResult::unsupported;
    const auto number = static_cast<std::size_t>(*which);
    if (number > receivers_.size()) return MavlinkResult::denied;
    const std::size_t first = number == 0 ? 0 : number - 1, last = number == 0 ? receivers_.size() : number;
    for (std::size_t i = first; i < last; ++i) {
        const FailureType wanted = fault == nullptr ? FailureType::ok : fault->type;
        if (injected_[i].type == wanted) {
            if (!keep(i)) return MavlinkResult::temporarily_rejected;
            continue;
        }
        if (!stop(i) || (fault != nullptr && !start(i, *fault))) return MavlinkResult::temporarily_rejected;
    }
    return MavlinkResult::accepted;
}

// A command comes twice where its acknowledgement was lost, and must not begin anew what is under way; what ctl or the
// page has ended meanwhile has to come back. The run knows which of both it is: it ignores the start of what is there.
bool FailureInjector::keep(std::size_t receiver) {
    const Injected& injected = injected_[receiver];
    return injected.type == FailureType::ok || tell(CommandVerb::start_fault, injected.name);
}

bool FailureInjector::stop(std::size_t receiver) {
    Injected& injected = injected_[receiver];
    if (injected.type == FailureType::ok) return true;
    if (!tell(CommandVerb::stop_fault, injected.name)) return false;
    injected = {};
    return true;
}

bool FailureInjector::tell(CommandVerb verb, const std::string& fault) {
    Command command;
    command.verb = verb;
    command.parameters = Parameters({{"fault", fault}});
    command.source = "mavlink";
    return push_(std::move(command));
}

bool FailureInjector::start(std::size_t receiver, const FailureFault& fault) {
    // Names are found again by the command that stops.
    const std::string name = fmt::format("mavlink {} {}", fault.word, started_ + 1);
    ParameterMap members = fault.parameters;
    members["kind"] = std::string(fault.kind);
    members["name"] = name;
    auto command = checked_live_fault(std::move(members), "mavlink");
    if (!command) return false;
    command->receivers = {receivers_[receiver]};
    if (!push_(std::move(*command))) return false;
    ++started_;
    injected_[receiver] = {fault.type, name};
    return true;
}

}  // namespace skyloop
