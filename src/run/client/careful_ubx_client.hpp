/// A client of u-blox receivers as autopilots are at their best.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "receiver/observed/ubx_epochs.hpp"
#include "run/client/careful_client.hpp"
#include "run/client/configuration_dialogue.hpp"

namespace skyloop {

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

}  // namespace skyloop
