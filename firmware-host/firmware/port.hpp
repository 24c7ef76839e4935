/// The transmit side of a port: byte timing and a buffer that overflows as a real one does.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "skyloop/base/bytes.hpp"
#include "skyloop/time/gps_time.hpp"

namespace skyloop::firmware {

/// The transmit side of one serial port, 8N1: each byte occupies the line for ten bits.
class Port {
public:
    static constexpr Nanoseconds longest_wait{10'000'000'000};

    Port(std::uint32_t baud, std::uint32_t buffer_bytes) : baud_(baud), buffer_bytes_(buffer_bytes) {}

    /// Queues one whole message whose first byte may leave at `ready`; false, and nothing queued, when it does not fit
    /// beside the bytes that have not left by then. Messages never interleave and leave in the order in which they were
    /// queued. Which byte leaves when depends on `ready` and the speed alone, not on when take() is called.
    /// @param patience for which the message may wait until there is room for it, at most longest_wait
    bool queue(ByteSpan message, GpsTime ready, Nanoseconds patience = Nanoseconds(0));
    /// The bytes whose stop bit has left by `now`. `now` never goes back, and is not later than the next `ready`.
    Bytes take(GpsTime now);
    /// The speed of all bytes that have not left by `now`. @param now between two bytes: see between_bytes()
    void set_baud(std::uint32_t baud, GpsTime now);
    /// The first instant from `now` on at which no byte is on its way.
    [[nodiscard]] GpsTime between_bytes(GpsTime now) const;
    /// Forgets what is queued.
    void clear();
    /// When the last queued byte will have left, or nothing.
    [[nodiscard]] std::optional<GpsTime> drained_at() const;
    /// When the first message that is queued will have left, or nothing.
    [[nodiscard]] std::optional<GpsTime> message_ends_at() const;
    [[nodiscard]] std::uint32_t baud() const { return baud_; }
    [[nodiscard]] std::uint32_t buffer_bytes() const { return static_cast<std::uint32_t>(buffer_bytes_); }
    /// Bytes queued and not yet taken, those among them that wait for room in the buffer.
    [[nodiscard]] std::size_t pending() const { return pending_; }

private:
    struct Message {
        Bytes bytes;
        GpsTime ready;
        GpsTime start;          ///< first start bit
        std::size_t taken = 0;  ///< bytes that have left
    };
    [[nodiscard]] Nanoseconds line_time(std::size_t bytes) const;
    [[nodiscard]] std::size_t departed(const Message& message, GpsTime now) const;

    std::uint32_t baud_;
    std::size_t buffer_bytes_;
    std::size_t pending_ = 0;
    GpsTime line_free_{};
    std::deque<Message> messages_;
};

}  // namespace skyloop::firmware
