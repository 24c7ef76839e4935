#include "run/feed/mavlink_component.hpp"

#include "receiver/protocol/mavlink_modes.hpp"

namespace skyloop {
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

}  // namespace skyloop
