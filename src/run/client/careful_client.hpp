/// What careful clients of both protocols have in common.
/// Finding the speed of a receiver's line.
/// A client of NMEA 0183 as autopilots are at their best.
/// A client of u-blox receivers as autopilots are at their best.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/time/gps_time.hpp"
#include "receiver/observed/nmea_epochs.hpp"
#include "receiver/observed/ubx_epochs.hpp"
#include "run/client/configuration_dialogue.hpp"
#include "run/client/health_checks.hpp"
#include "run/client/scripted_client.hpp"

namespace skyloop::inline run {

/// Tries one speed after the other until it is told that something whole was heard.
///
/// ArduPilot tries each of its speeds for 1.2 s, Betaflight for about a second (RECEIVER.md 6.2, 6.4).
class PortHunt {
public:
    /// @param speeds bit/s, in the order of trial, at least one
    /// @param dwell how long each is tried
    PortHunt(std::vector<std::uint32_t> speeds, Nanoseconds dwell) : speeds_(std::move(speeds)), dwell_(dwell) {}

    /// Begins with the speed at which there was something last, then tries them all, again and again.
    void start(GpsTime now);
    /// Whether it is time to speak up at a new speed.
    bool advance(GpsTime now);
    /// Something whole was heard at this speed.
    void found();
    [[nodiscard]] bool hunting() const { return hunting_; }
    [[nodiscard]] std::uint32_t speed() const { return speed_; }
    /// The client has made the receiver change to another speed.
    void set_speed(std::uint32_t speed) { speed_ = speed; }

private:
    std::vector<std::uint32_t> speeds_;
    Nanoseconds dwell_;
    bool hunting_ = false, first_ = true;
    std::size_t next_ = 0;
    std::uint32_t speed_ = 9600;
    std::optional<std::uint32_t> known_;
    GpsTime since_{};
};

/// The speeds at which receivers are found, the usual factory settings first, bit/s.
std::vector<std::uint32_t> usual_speeds();

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

/// Finds the speed by listening, puts GGA and RMC of the same time together, asks that both, and GSA where it comes,
/// agree that there is a fix, and judges the whole by HealthChecks. It tells the receiver nothing.
class CarefulNmeaClient : public CarefulClient {
public:
    CarefulNmeaClient() : CarefulClient("careful-nmea") {}

protected:
    void hear_message(const StreamPiece& piece) override;
    [[nodiscard]] bool shows_speed(const StreamPiece& piece) const override { return piece.kind == StreamKind::nmea; }
    void speed_found() override;
    void watch() override;

private:
    void combine(const NmeaEpoch& epoch);

    NmeaEpochs epochs_;
    unsigned parts_ = 0;  // of GGA and RMC in this epoch
    GpsTime solution_at_{};
};

/// Finds the speed, asks who the receiver is and goes on without an answer, configures it step by step, reads settings
/// back, and does all of it again when messages stop or sentences come that it had switched off. Every solution goes
/// through HealthChecks, and what the receiver says of interference and spoofing counts as well.
class CarefulUbxClient : public CarefulClient {
public:
    CarefulUbxClient() : CarefulClient("careful-ubx") {}

protected:
    void hear_message(const StreamPiece& piece) override;
    [[nodiscard]] bool shows_speed(const StreamPiece& piece) const override;
    void speed_found() override;
    void at_new_speed() override;
    void watch() override;

private:
    void configure(const char* reason);
    void hear_frame(const UbxFrameView& frame);
    void hear_epoch(const UbxFrameView& frame);
    void hear_solution(const ObservedEpoch& epoch);
    void hear_time(ByteSpan payload);
    void hear_status(ByteSpan payload);
    void hear_warning(bool critical, const char* what);
    void watch_messages();
    void watch_interference();

    std::optional<ConfigurationDialogue> dialogue_;
    GpsTime configured_at_{};
    GpsTime solution_at_{};
    std::map<UbxMessageId, GpsTime> heard_at_;  // of messages that come with epochs, since they were asked for
    std::optional<GpsTime> warned_at_;
    std::string warning_;
    struct GpsTimeHeard {
        std::uint32_t i_tow = 0;
        double seconds = 0;
    };
    UbxEpochs epochs_;
    unsigned parts_ = 0;                    // of an epoch without NAV-PVT
    std::optional<GpsTimeHeard> gps_time_;  // of the last NAV-TIMEGPS
};

}  // namespace skyloop::inline run
