/// What careful clients of both protocols have in common.
#pragma once

#include <deque>
#include <optional>
#include <string>

#include "run/client/health_checks.hpp"
#include "run/client/port_hunt.hpp"
#include "run/client/scripted_client.hpp"

namespace skyloop {

/// Hunts speeds, hunts again after a silence, watches the damage on the line, and trusts a receiver only after its
/// solutions have passed all checks for a while. A doubt counts at once.
class CarefulClient : public ScriptedClient {
protected:
    explicit CarefulClient(std::string name);

    void start() override;
    void hear(const StreamPiece& piece) final;
    void pass_time() final;

    /// A whole message of this client's protocols, at a speed that has been found.
    virtual void hear_message(const StreamPiece& piece) = 0;
    /// Whether a message shows that the speed is right.
    [[nodiscard]] virtual bool shows_speed(const StreamPiece& piece) const = 0;
    /// Something whole was heard after a hunt.
    virtual void speed_found() = 0;
    /// A new speed is tried: the moment to provoke an answer.
    virtual void at_new_speed() {}
    /// Time passes at a speed that has been found.
    virtual void watch() = 0;

    void judge(const HeardSolution& solution);
    void doubt(std::string reason);
    void hunt();
    /// The client made the receiver change its speed.
    void follow_speed(std::uint32_t speed);
    void forget_timing() { health_.forget_timing(); }

private:
    void watch_damage();

    PortHunt hunt_;
    HealthChecks health_;
    GpsTime last_message_{};
    std::optional<GpsTime> sound_since_;
    std::uint64_t damaged_before_ = 0, skipped_before_ = 0;  // of the counts when they were last looked at
    std::deque<GpsTime> damages_;
};

}  // namespace skyloop
