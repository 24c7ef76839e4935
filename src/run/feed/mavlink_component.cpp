#include "run/feed/mavlink_component.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "receiver/protocol/mavlink.hpp"
#include "run/fault/command.hpp"

namespace skyloop::inline run {
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

namespace {

using namespace std::chrono_literals;

constexpr auto shortest_between_states = 50ms;
// Each new fault stays in the run's timeline: a peer gone wild must not fill the memory.
constexpr int most_injections_a_second = 20;
constexpr std::uint8_t type_gcs = 6, type_onboard_controller = 18;  // MAV_TYPE

}  // namespace

MavlinkComponent::MavlinkComponent(std::vector<std::string> receivers, const CommandSink& push)
    : injector_(std::move(receivers), push), push_(push) {}

MavlinkSource MavlinkComponent::next_source() { return {mavlink_own_system, mavlink_own_component, sequence_++}; }

Bytes MavlinkComponent::heartbeat() {
    MavlinkHeartbeat alive;
    alive.type = type_onboard_controller;
    alive.autopilot = mavlink_autopilot_none;
    return encode_mavlink(next_source(), alive);
}

MavlinkComponent::Heard MavlinkComponent::hear(ByteSpan datagram, Time now) {
    Heard heard;
    for (const MavlinkFrameView& frame : mavlink_frames(datagram)) {
        heard.any = true;
        switch (frame.message) {
            case MavlinkHeartbeat::message_id:
                follow(frame);
                break;
            case MavlinkCommandLong::message_id:
                obey<MavlinkCommandLong>(frame, heard.answers, now);
                break;
            case MavlinkCommandInt::message_id:
                obey<MavlinkCommandInt>(frame, heard.answers, now);
                break;
            default:
                break;
        }
    }
    look(now);
    return heard;
}

// The first autopilot is the vehicle: cameras, gimbals and ground stations have heartbeats, too, and no mode.
void MavlinkComponent::follow(const MavlinkFrameView& frame) {
    const auto heartbeat = decode_mavlink<MavlinkHeartbeat>(frame.payload);
    if (heartbeat.autopilot == mavlink_autopilot_none || heartbeat.type == type_gcs) return;
    const std::pair who{frame.source.system, frame.source.component};
    if (!vehicle_) vehicle_ = who;
    if (*vehicle_ != who) return;
    state_.mode = mavlink_mode_name(heartbeat);
    state_.custom_mode.reset();
    if ((heartbeat.base_mode & mavlink_custom_mode_enabled) != 0) state_.custom_mode = heartbeat.custom_mode;
    state_.armed = (heartbeat.base_mode & mavlink_safety_armed) != 0;
}

void MavlinkComponent::look(Time now) {
    if (state_ == told_ || (told_at_ && now < *told_at_ + shortest_between_states)) return;
    if (!push_(vehicle_state_command(state_, "mavlink"))) return;
    told_ = state_;
    told_at_ = now;
}

template <class CommandMessage>
void MavlinkComponent::obey(const MavlinkFrameView& frame, std::vector<Bytes>& answers, Time now) {
    const auto command = decode_mavlink<CommandMessage>(frame.payload);
    const bool for_all = command.target_system == 0;
    if (!for_all && command.target_system != mavlink_own_system) return;
    if (command.target_component != 0 && command.target_component != mavlink_own_component) return;
    MavlinkCommandAck ack;
    ack.command = command.command;
    ack.target_system = frame.source.system;
    ack.target_component = frame.source.component;
    if (command.command == mavlink_inject_failure)
        ack.result = static_cast<std::uint8_t>(inject(command.param1, command.param2, command.param3, now));
    else if (for_all)
        return;  // others may know it
    else
        ack.result = static_cast<std::uint8_t>(MavlinkResult::unsupported);
    answers.push_back(encode_mavlink(next_source(), ack));
}

MavlinkResult MavlinkComponent::inject(float unit, float type, float instance, Time now) {
    if (now >= injections_since_ + 1s) {
        injections_since_ = now;
        injections_ = 0;
    }
    if (++injections_ > most_injections_a_second) return MavlinkResult::temporarily_rejected;
    return injector_.inject(unit, type, instance);
}

}  // namespace skyloop::inline run
