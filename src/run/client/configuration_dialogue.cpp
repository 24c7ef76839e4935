#include "run/client/configuration_dialogue.hpp"

#include <fmt/format.h>

#include <utility>

#include "receiver/protocol/ubx_fields.hpp"
#include "receiver/protocol/ubx_mon.hpp"

namespace skyloop {
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

void ConfigurationDialogue::give_up_step() {
    ++unanswered_;
    mute_ = mute_ || !steps_[current_].next_speed;
    if (steps_[current_].next_speed) speed_ = steps_[current_].next_speed;
    ++current_;
    attempts_ = 0;
}

void ConfigurationDialogue::finish_step(bool change_speed) {
    ++confirmed_;
    mute_ = false;
    if (change_speed && steps_[current_].next_speed) speed_ = steps_[current_].next_speed;
    ++current_;
    attempts_ = 0;
}

void ConfigurationDialogue::take_refusal() {
    const DialogueStep step = std::move(steps_[current_]);
    mute_ = false;
    ++refused_;
    if (step.needed)
        failure_ = fmt::format("the receiver refuses message {:02X}-{:02X}", step.id.message_class, step.id.id);
    ++current_;
    attempts_ = 0;
    steps_.insert(steps_.begin() + static_cast<std::ptrdiff_t>(current_), step.otherwise.begin(), step.otherwise.end());
}

void ConfigurationDialogue::hear_acknowledgement(bool accepted) {
    if (!accepted) return take_refusal();
    const DialogueStep& step = steps_[current_];
    has_acknowledgement_ = true;
    if (!step.answer || has_answer_) finish_step(true);
}

void ConfigurationDialogue::hear(UbxMessageId id, ByteSpan payload) {
    if (!failure_.empty() || current_ >= steps_.size() || attempts_ == 0) return;
    const DialogueStep& step = steps_[current_];
    if (step.answer == id) {
        if (step.accept && !step.accept(payload)) return;
        has_answer_ = true;
        if (!step.acknowledged || has_acknowledgement_) finish_step(true);
        return;
    }
    if (id != AckAck::message_id && id != AckNak::message_id) return;
    // Both class and id count: a late acknowledgement of an earlier step must not confirm this one.
    const auto acknowledgement = decode_payload<AckAck>(payload);
    if (!acknowledgement || UbxMessageId{acknowledgement->message_class, acknowledgement->id} != step.id) return;
    hear_acknowledgement(id == AckAck::message_id);
}

std::optional<std::uint32_t> ConfigurationDialogue::take_speed() { return std::exchange(speed_, std::nullopt); }

}  // namespace skyloop
