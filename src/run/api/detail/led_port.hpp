/// The end of a wire that a program holds.
#pragma once

#include <cstddef>
#include <deque>
#include <span>
#include <string>

#include "wire/transport/transport.hpp"

namespace skyloop::inline run {

/// Keeps what the receiver has sent until the caller takes it, and brings the caller's bytes to the receiver at the
/// speed of a line: 8N1; a port without a speed at 12 Mbit/s, the full speed of USB 2.0.
///
/// The receiver hears on whole milliseconds of GPS time alone, all that has arrived by then, as a driver that polls:
/// what it does depends on when the bytes set out, not on how the caller cuts time into stretches.
class LedPort : public Transport, public SimulatedEnd {
public:
    explicit LedPort(std::string name) : name_(std::move(name)) {}

    std::size_t write(ByteSpan bytes) override;
    Bytes read() override;
    LineState line() override { return {true, baud_}; }
    void set_receiver_baud(std::uint32_t baud) override { receiver_baud_ = baud; }
    SimulatedEnd* simulated_end() override { return this; }
    void tell_time(GpsTime now) override { now_ = now; }
    [[nodiscard]] std::optional<GpsTime> acts_at(GpsTime now) const override;
    [[nodiscard]] std::string description() const override { return name_ + " (caller)"; }

    /// Moves bytes that have left the receiver into the buffer; gives how many.
    std::size_t take(std::span<std::uint8_t> buffer);
    [[nodiscard]] std::size_t pending() const { return left_.size() - taken_; }
    /// Bytes set out to the receiver at `now`, or after those before them; gives how many were taken.
    std::size_t give(ByteSpan bytes, GpsTime now);
    /// Of the caller's own end, for bytes given from now on and for what it hears; nothing: always the receiver's.
    void set_baud(std::optional<std::uint32_t> baud) { baud_ = baud; }

    static constexpr std::size_t most_left = std::size_t{64} << 20U, most_waiting = std::size_t{1} << 20U;

private:
    struct Piece {
        Bytes bytes;
        GpsTime start;  ///< of the first start bit
        Nanoseconds byte_time{1};
        std::size_t taken = 0;
    };
    [[nodiscard]] Nanoseconds byte_time() const;

    std::string name_;
    Bytes left_;             // by the receiver, not taken by the caller from taken_ on
    std::size_t taken_ = 0;  // of left_
    std::deque<Piece> coming_;
    std::size_t waiting_ = 0;  // bytes in coming_
    GpsTime line_free_{};
    GpsTime now_{};  // of the last look
    std::optional<std::uint32_t> baud_;
    std::uint32_t receiver_baud_ = 0;  // 0: the port has no speed
};

}  // namespace skyloop::inline run
