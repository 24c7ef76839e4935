#include "run/client/configuration_dialogue.hpp"

#include <fmt/format.h>

#include <utility>

#include "receiver/protocol/ubx_cfg.hpp"
#include "receiver/protocol/ubx_fields.hpp"
#include "receiver/protocol/ubx_hardware.hpp"
#include "receiver/protocol/ubx_mon.hpp"
#include "receiver/protocol/ubx_nav.hpp"
#include "receiver/protocol/ubx_time.hpp"

namespace skyloop::inline run {
namespace {

constexpr Nanoseconds answer_time = std::chrono::milliseconds(500);
constexpr Nanoseconds mute_answer_time = std::chrono::milliseconds(200);
// A receiver answers CFG-PRT at either speed (RECEIVER.md 6.1); PX4 waits 0.25 s and changes in any case.
constexpr Nanoseconds speed_change_time = std::chrono::milliseconds(250);
constexpr int most_attempts = 3;

}  // namespace

std::optional<Bytes> ConfigurationDialogue::advance(GpsTime now) {
    while (failure_.empty() && current_ < steps_.size()) {
        const DialogueStep& step = steps_[current_];
        if (attempts_ == 0) break;
        const Nanoseconds wait = step.next_speed ? speed_change_time : mute_ ? mute_answer_time : answer_time;
        if (now - sent_at_ < wait) return std::nullopt;
        if (attempts_ < (mute_ || step.next_speed ? 1 : most_attempts)) break;
        give_up_step();
    }
    if (!failure_.empty() || current_ >= steps_.size() || speed_) return std::nullopt;
    ++attempts_;
    sent_at_ = now;
    has_answer_ = has_acknowledgement_ = false;
    return steps_[current_].request;
}

void ConfigurationDialogue::next_step() {
    ++current_;
    attempts_ = 0;
}

void ConfigurationDialogue::give_up_step() {
    ++unanswered_;
    mute_ = mute_ || !steps_[current_].next_speed;
    if (steps_[current_].next_speed) speed_ = steps_[current_].next_speed;
    next_step();
}

void ConfigurationDialogue::finish_step() {
    ++confirmed_;
    mute_ = false;
    if (steps_[current_].next_speed) speed_ = steps_[current_].next_speed;
    next_step();
}

void ConfigurationDialogue::take_refusal() {
    const DialogueStep step = std::move(steps_[current_]);
    mute_ = false;
    ++refused_;
    if (step.needed)
        failure_ = fmt::format("the receiver refuses message {:02X}-{:02X}", step.id.message_class, step.id.id);
    next_step();
    steps_.insert(steps_.begin() + static_cast<std::ptrdiff_t>(current_), step.otherwise.begin(), step.otherwise.end());
}

void ConfigurationDialogue::hear_acknowledgement(bool accepted) {
    if (!accepted) return take_refusal();
    const DialogueStep& step = steps_[current_];
    has_acknowledgement_ = true;
    if (!step.answer || has_answer_) finish_step();
}

void ConfigurationDialogue::hear(UbxMessageId id, ByteSpan payload) {
    if (!failure_.empty() || current_ >= steps_.size() || attempts_ == 0) return;
    const DialogueStep& step = steps_[current_];
    if (step.answer == id) {
        if (step.accept && !step.accept(payload)) return;
        has_answer_ = true;
        if (!step.acknowledged || has_acknowledgement_) finish_step();
        return;
    }
    if (id != AckAck::message_id && id != AckNak::message_id) return;
    // Both class and id count: a late acknowledgement of an earlier step must not confirm this one.
    const auto acknowledgement = decode_payload<AckAck>(payload);
    if (!acknowledgement || UbxMessageId{acknowledgement->message_class, acknowledgement->id} != step.id) return;
    hear_acknowledgement(id == AckAck::message_id);
}

std::optional<std::uint32_t> ConfigurationDialogue::take_speed() { return std::exchange(speed_, std::nullopt); }

namespace {

constexpr std::uint32_t client_speed = 115200;  // what PX4 sets
constexpr std::uint8_t uart1 = 1;
constexpr std::uint32_t frame_8n1 = 0x8D0;  // CFG-PRT mode, as PX4 sends it
constexpr std::uint16_t in_ubx_nmea_rtcm3 = 0x23;
constexpr std::uint16_t out_ubx = 0x01;
constexpr std::uint8_t airborne_4g = 8;
constexpr std::uint8_t fix_3d_only = 2;
constexpr std::uint16_t model_and_fix_mode = 0x0005;

template <class Message>
DialogueStep setting(const Message& message) {
    return {Message::message_id, encode_frame(message)};
}

DialogueStep message_on(UbxMessageId id, std::uint8_t every) {
    return setting(CfgMsgCurrentPort{id.message_class, id.id, every});
}

DialogueStep poll(UbxMessageId id, Bytes payload = {}) {
    DialogueStep step{id, encode_frame(id, payload)};
    step.answer = id;
    return step;
}

DialogueStep port_setting() {
    CfgPrtItem port;
    port.port_id = uart1;
    port.mode = frame_8n1;
    port.baud_rate = client_speed;
    port.in_proto_mask = in_ubx_nmea_rtcm3;
    port.out_proto_mask = out_ubx;
    DialogueStep step = setting(CfgPrt{{port}});
    step.next_speed = client_speed;
    return step;
}

DialogueStep rate_read_back() {
    DialogueStep step = poll(CfgRate::message_id);
    step.accept = [](ByteSpan payload) {
        const auto rate = decode_payload<CfgRate>(payload);
        return rate && rate->meas_rate == ubx_client_period_ms;
    };
    return step;
}

DialogueStep message_read_back(UbxMessageId id) {
    DialogueStep step = poll(CfgMsg::message_id, {id.message_class, id.id});
    step.accept = [id](ByteSpan payload) {
        const auto message = decode_payload<CfgMsg>(payload);
        return message && UbxMessageId{message->message_class, message->id} == id && message->rates[uart1] == 1;
    };
    return step;
}

DialogueStep solution_on() {
    DialogueStep old = message_on(NavSol::message_id, 1);
    old.needed = true;
    DialogueStep step = message_on(NavPvt::message_id, 1);
    step.otherwise = {old, message_on(NavPosllh::message_id, 1), message_on(NavVelned::message_id, 1),
                      message_on(NavTimeutc::message_id, 1), message_read_back(NavSol::message_id)};
    return step;
}

}  // namespace

std::vector<DialogueStep> ubx_configuration() {
    DialogueStep version = poll(MonVer::message_id);
    version.acknowledged = false;
    DialogueStep model = setting([] {
        CfgNav5 nav5;
        nav5.mask = model_and_fix_mode;
        nav5.dyn_model = airborne_4g;
        nav5.fix_mode = fix_3d_only;
        return nav5;
    }());
    return {version,
            port_setting(),
            setting(CfgRate{ubx_client_period_ms, 1, 1}),
            model,
            solution_on(),
            message_on(NavStatus::message_id, 1),
            message_on(NavTimegps::message_id, 1),
            message_on({0x0A, 0x09}, 5),  // MON-HW, of M8
            message_on(MonRf::message_id, 5),
            message_on(SecSig2::message_id, 5),
            rate_read_back(),
            message_read_back(NavPvt::message_id)};
}

}  // namespace skyloop::inline run
