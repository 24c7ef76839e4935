/// Bytes that wait for their time, the end of a stall, or the throughput of a wire.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "base/core/bytes.hpp"
#include "base/time/gps_time.hpp"

namespace skyloop {

/// First in, first out. Where the throughput is limited each byte takes its time, 1/rate, one after the other; the
/// share of that time that has passed is kept when the rate changes. What has left by an instant does not depend on
/// when one looked before.
class WireQueue {
public:
    /// From `now` on, to which release() must have come.
    /// @param bytes_per_s above zero; nothing: no limit
    void set(bool stalled, std::optional<double> bytes_per_s, GpsTime now);
    /// Everything in here is due at `now` at the latest.
    void hasten(GpsTime now);
    /// Whether a byte due at `due` would leave at `now` without waiting.
    [[nodiscard]] bool lets_through(GpsTime due, GpsTime now) const;
    /// Queues what fits of `bytes`, due not before those before them; the number of those that do not.
    std::size_t push(ByteSpan bytes, GpsTime due, std::size_t capacity);
    /// Appends what has left by `now`.
    void release(GpsTime now, Bytes& out);
    /// When the next byte leaves; nothing: none waits, or it waits for the end of a stall.
    [[nodiscard]] std::optional<GpsTime> next_at() const;
    [[nodiscard]] std::size_t size() const { return bytes_.size(); }
    /// Throws everything away; how many bytes that were.
    std::size_t clear();

private:
    struct Run {
        GpsTime due;
        std::size_t count;
    };
    [[nodiscard]] GpsTime leaves(std::uint64_t number) const;
    [[nodiscard]] GpsTime free_at() const { return served_ == 0 ? anchor_ : leaves(served_); }
    [[nodiscard]] std::size_t served_of(const Run& run, GpsTime now) const;
    [[nodiscard]] double progress_at(GpsTime now) const;
    void begin_service(GpsTime at, double progress);

    std::deque<std::uint8_t> bytes_;
    std::deque<Run> runs_;  // their dues do not decrease
    bool stalled_ = false;
    std::optional<double> rate_;
    // Since `anchor_`, where `progress_` of a byte had passed, `served_` bytes have left without a gap.
    GpsTime anchor_{};
    double progress_ = 0;
    std::uint64_t served_ = 0;
};

}  // namespace skyloop
