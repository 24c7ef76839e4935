/// Clients as they are found in sketches and hurried drivers: what they do not ask for will happen to them.
#pragma once

#include "run/client/scripted_client.hpp"

namespace skyloop {

/// Asks for MON-VER at 9600 bit/s and waits for it for ever, switches NAV-PVT on once, and takes each NAV-PVT whose
/// fix type is one. Silence, old positions, accuracies and times are nothing to it.
class NaiveUbxClient : public ScriptedClient {
public:
    NaiveUbxClient() : ScriptedClient("naive-ubx") {}

protected:
    void start() override { begun_at_ = now(); }
    void hear(const StreamPiece& piece) override;
    void pass_time() override;

private:
    GpsTime begun_at_{};
    bool asked_ = false, identified_ = false;
};

/// Listens at 9600 bit/s and takes each GGA that has a position, whatever its quality.
class NaiveNmeaClient : public ScriptedClient {
public:
    NaiveNmeaClient() : ScriptedClient("naive-nmea") {}

protected:
    void hear(const StreamPiece& piece) override;
    void pass_time() override {}
};

}  // namespace skyloop
