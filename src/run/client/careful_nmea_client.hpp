/// A client of NMEA 0183 as autopilots are at their best.
#pragma once

#include "receiver/observed/nmea_epochs.hpp"
#include "run/client/careful_client.hpp"

namespace skyloop {

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

}  // namespace skyloop
