#include "run/client/careful_client.hpp"

#include <fmt/format.h>

namespace skyloop {
namespace {

// INAV gives a receiver up after 1 s, Betaflight after 2.5 s, ArduPilot after 4 s (RECEIVER.md section 6).
constexpr Nanoseconds longest_silence = std::chrono::seconds(2);
// A receiver at 1 Hz must have a chance at each speed.
constexpr Nanoseconds dwell_time = std::chrono::milliseconds(1200);
// PX4 asks for 10 s of good checks (EKF2_REQ_GPS_H) before it uses a receiver; half of it keeps scenarios short.
constexpr Nanoseconds settling_time = std::chrono::seconds(5);
// So many damaged messages within so long are more than a spark.
constexpr std::size_t damages_allowed = 3;
constexpr Nanoseconds damage_memory = std::chrono::seconds(5);
constexpr std::uint64_t loose_bytes_of_damage = 16;

}  // namespace

CarefulClient::CarefulClient(std::string name) : ScriptedClient(std::move(name)), hunt_(usual_speeds(), dwell_time) {}

void CarefulClient::start() {
    health_ = HealthChecks(HealthLimits::made_before(now()));
    hunt();
}

void CarefulClient::hunt() {
    hunt_.start(now());
    forget_timing();
    damages_.clear();
}

void CarefulClient::follow_speed(std::uint32_t speed) {
    hunt_.set_speed(speed);
    set_speed(speed);
    damaged_before_ = skipped_before_ = 0;
    damages_.clear();
}

void CarefulClient::hear(const StreamPiece& piece) {
    if (piece.kind == StreamKind::noise || !shows_speed(piece)) return;
    last_message_ = now();
    if (hunt_.hunting()) {
        hunt_.found();
        damaged_before_ = skipped_before_ = 0;
        damaged_before_ = counts().bad[0] + counts().bad[1];
        skipped_before_ = counts().skipped;
        damages_.clear();
        speed_found();
    }
    hear_message(piece);
}

void CarefulClient::pass_time() {
    if (hunt_.advance(now())) {
        set_speed(hunt_.speed());
        at_new_speed();
    }
    if (hunt_.hunting()) return;
    if (now() - last_message_ > longest_silence) {
        doubt("no message for 2 s");
        hunt();
        return;
    }
    watch_damage();
    watch();
}

void CarefulClient::watch_damage() {
    const std::uint64_t damaged = counts().bad[0] + counts().bad[1];
    const std::uint64_t skipped = counts().skipped;
    if (damaged > damaged_before_ || skipped >= skipped_before_ + loose_bytes_of_damage) {
        damages_.push_back(now());
        damaged_before_ = damaged;
        skipped_before_ = skipped;
    }
    while (!damages_.empty() && now() - damages_.front() > damage_memory)
        damages_.pop_front();
    if (damages_.size() > damages_allowed) doubt(fmt::format("{} damaged messages within 5 s", damages_.size()));
}

void CarefulClient::judge(const HeardSolution& solution) {
    if (auto reason = health_.doubt(solution)) {
        doubt(std::move(*reason));
        return;
    }
    if (damages_.size() > damages_allowed) return;
    if (!sound_since_) sound_since_ = now();
    if (now() - *sound_since_ >= settling_time) believe(true, "all checks passed for 5 s");
}

void CarefulClient::doubt(std::string reason) {
    sound_since_.reset();
    believe(false, std::move(reason));
}

}  // namespace skyloop
