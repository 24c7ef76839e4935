#include "detail/led_port.hpp"

#include <algorithm>

#include "base/core/bytes.hpp"

namespace skyloop::inline run {
namespace {

constexpr Nanoseconds driver_look{1'000'000};
constexpr std::int64_t usb_byte_ns = 667;  // eight bits at 12 Mbit/s (USB 2.0, section 4.2.1), rounded up

GpsTime last_look(GpsTime time) { return time - time.time_since_epoch() % driver_look; }

}  // namespace

std::size_t LedPort::write(ByteSpan bytes) {
    if (taken_ > 0 && taken_ * 2 >= left_.size()) {
        left_.erase(left_.begin(), left_.begin() + static_cast<std::ptrdiff_t>(taken_));
        taken_ = 0;
    }
    const ByteSpan accepted = bytes.first(std::min(bytes.size(), most_left - std::min(most_left, pending())));
    left_.insert(left_.end(), accepted.begin(), accepted.end());
    return accepted.size();
}

std::size_t LedPort::take(std::span<std::uint8_t> buffer) {
    const std::size_t count = std::min(buffer.size(), pending());
    std::copy_n(left_.begin() + static_cast<std::ptrdiff_t>(taken_), count, buffer.begin());
    taken_ += count;
    if (taken_ == left_.size()) {
        left_.clear();
        taken_ = 0;
    }
    return count;
}

Nanoseconds LedPort::byte_time() const {
    if (receiver_baud_ == 0) return Nanoseconds(usb_byte_ns);
    return Nanoseconds(SerialFormat{}.byte_ns(baud_.value_or(receiver_baud_)));
}

std::size_t LedPort::give(ByteSpan bytes, GpsTime now) {
    const ByteSpan accepted = bytes.first(std::min(bytes.size(), most_waiting - std::min(most_waiting, waiting_)));
    if (accepted.empty()) return 0;
    Piece piece{Bytes(accepted.begin(), accepted.end()), std::max(line_free_, now), byte_time()};
    line_free_ = piece.start + piece.byte_time * static_cast<std::int64_t>(accepted.size());
    waiting_ += accepted.size();
    coming_.push_back(std::move(piece));
    return accepted.size();
}

Bytes LedPort::read() {
    Bytes arrived;
    const GpsTime look = last_look(now_);
    while (!coming_.empty()) {
        Piece& piece = coming_.front();
        const auto by_now = std::max<std::int64_t>(0, (look - piece.start) / piece.byte_time);
        const std::size_t until = std::min(piece.bytes.size(), static_cast<std::size_t>(by_now));
        if (until > piece.taken)
            arrived.insert(arrived.end(), piece.bytes.begin() + static_cast<std::ptrdiff_t>(piece.taken),
                           piece.bytes.begin() + static_cast<std::ptrdiff_t>(until));
        piece.taken = std::max(piece.taken, until);
        if (piece.taken < piece.bytes.size()) break;
        coming_.pop_front();
    }
    waiting_ -= arrived.size();
    return arrived;
}

std::optional<GpsTime> LedPort::acts_at(GpsTime now) const {
    if (coming_.empty()) return std::nullopt;
    const Piece& next = coming_.front();
    const GpsTime arrives = next.start + next.byte_time * static_cast<std::int64_t>(next.taken + 1);
    const GpsTime look = last_look(arrives + driver_look - Nanoseconds(1));
    // What has arrived already, and was not asked for, is so at the next look.
    return std::max(look, last_look(now) + driver_look);
}

}  // namespace skyloop::inline run
