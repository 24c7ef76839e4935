/// Asking and telling a receiver one thing after the other.
/// How a careful client sets a u-blox receiver up.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/time/gps_time.hpp"
#include "receiver/protocol/ubx_frame.hpp"

namespace skyloop::inline run {

/// One message to a receiver and what answers it.
struct DialogueStep {
    UbxMessageId id;
    Bytes request{};                            ///< a whole frame
    std::optional<UbxMessageId> answer{};       ///< a message that has to come; nothing: the acknowledgement is all
    std::function<bool(ByteSpan)> accept{};     ///< whether its payload is what was wanted; none: any is
    bool acknowledged = true;                   ///< ACK-ACK or ACK-NAK comes, after an answer too
    bool needed = false;                        ///< a refusal ends the dialogue
    std::vector<DialogueStep> otherwise{};      ///< what comes next where it is refused
    std::optional<std::uint32_t> next_speed{};  ///< bit/s of the line once it is done; the client goes along
};

/// Goes through steps with time limits and repetitions, and on without what is never answered.
///
/// Three attempts of 0.5 s each: PX4 waits 0.25 to 2 s, Betaflight 0.15 s, ArduPilot 0.3 s and repeats for ever
/// (RECEIVER.md section 6). Once a step has stayed without any answer, later ones get one attempt of 0.2 s until one
/// is answered, so that a mute receiver does not hold up the client. State: the step under way.
class ConfigurationDialogue {
public:
    explicit ConfigurationDialogue(std::vector<DialogueStep> steps) : steps_(std::move(steps)) {}

    /// What is to be sent now, or nothing.
    std::optional<Bytes> advance(GpsTime now);
    /// A message of the receiver.
    void hear(UbxMessageId id, ByteSpan payload);
    /// The speed to change to, once.
    std::optional<std::uint32_t> take_speed();

    [[nodiscard]] bool done() const { return failure_.empty() && current_ >= steps_.size(); }
    /// A refusal of something needed; empty while there was none.
    [[nodiscard]] const std::string& failure() const { return failure_; }
    /// Steps that were confirmed.
    [[nodiscard]] int confirmed() const { return confirmed_; }
    /// Steps that were refused, or never answered.
    [[nodiscard]] int refused() const { return refused_; }
    [[nodiscard]] int unanswered() const { return unanswered_; }

private:
    void next_step();
    void finish_step();
    void give_up_step();
    void take_refusal();
    void hear_acknowledgement(bool accepted);

    std::vector<DialogueStep> steps_;
    std::size_t current_ = 0;
    int attempts_ = 0, confirmed_ = 0, refused_ = 0, unanswered_ = 0;
    bool has_answer_ = false, has_acknowledgement_ = false, mute_ = false;
    GpsTime sent_at_{};
    std::optional<std::uint32_t> speed_;
    std::string failure_;
};

/// What the careful client asks and tells: identification, port, rate, dynamic model, messages, and settings read back.
/// Where NAV-PVT is refused it takes the older messages, as PX4 and ArduPilot do.
std::vector<DialogueStep> ubx_configuration();

/// The period of solutions that the careful client asks for, ms: 5 Hz, the default of ArduPilot and INAV.
inline constexpr std::uint16_t ubx_client_period_ms = 200;

}  // namespace skyloop::inline run
