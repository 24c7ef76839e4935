/// The emulated receiver: epochs and bytes in, bytes out. It has no clock, no threads and no operating system.
#pragma once

#include <cstdint>
#include <optional>

#include "firmware/board_profile.hpp"
#include "firmware/nmea_handler.hpp"
#include "firmware/port.hpp"
#include "skyloop/base/bytes.hpp"
#include "skyloop/flow/epoch.hpp"
#include "skyloop/flow/receiver_settings.hpp"
#include "skyloop/time/gps_time.hpp"

namespace skyloop::firmware {

/// What a receiver counts about itself.
struct ReceiverCounters {
    std::uint64_t epochs = 0;
    std::uint64_t messages_sent = 0;
    std::uint64_t messages_dropped = 0;  ///< the transmit buffer was full
    std::uint64_t bytes_received = 0;
};

/// One receiver with one UART. It is mute: it swallows what a client sends and streams its factory sentences.
class Receiver {
public:
    /// @param rate_hz navigation rate at start, limited to the board's maximum; one that is not above zero gives the
    ///        board's own. The period is whole milliseconds, as real receivers store it.
    /// @param settings at start; their period is replaced by that of the rate
    Receiver(BoardProfile board, double rate_hz, ReceiverSettings settings = {});

    void input(ByteSpan bytes, GpsTime now);
    /// A new solution: its messages are queued and begin to leave one solution latency after `epoch.fix.time`.
    void on_epoch(const Epoch& epoch);
    /// The bytes that have left the UART between the last call and `now`, at the port's speed.
    Bytes output(GpsTime now);
    /// When the last queued byte will have left, or nothing when nothing is queued.
    [[nodiscard]] std::optional<GpsTime> drained_at() const;
    [[nodiscard]] std::uint32_t baud() const { return port_.baud(); }
    [[nodiscard]] const ReceiverSettings& settings() const { return settings_; }
    [[nodiscard]] const ReceiverCounters& counters() const { return counters_; }
    [[nodiscard]] const BoardProfile& board() const { return board_; }

private:
    BoardProfile board_;
    ReceiverSettings settings_;
    ReceiverCounters counters_;
    NmeaHandler nmea_;
    Port port_;
};

}  // namespace skyloop::firmware
