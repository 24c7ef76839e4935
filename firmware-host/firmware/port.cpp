#include "firmware/port.hpp"

#include <algorithm>

namespace skyloop::firmware {
namespace {

constexpr std::int64_t nanoseconds_per_byte_at_1_baud = 10 * std::int64_t{1'000'000'000};  // start, eight data, stop

}  // namespace

// Rounded up: at the end of it the last stop bit has left whole.
Nanoseconds Port::line_time(std::size_t bytes) const {
    const std::int64_t total = static_cast<std::int64_t>(bytes) * nanoseconds_per_byte_at_1_baud;
    return Nanoseconds((total + baud_ - 1) / baud_);
}

std::size_t Port::departed(const Message& message, GpsTime now) const {
    if (now < message.start) return 0;
    const Nanoseconds since = now - message.start;
    if (since >= line_time(message.bytes.size())) return message.bytes.size();
    return static_cast<std::size_t>(since.count() * baud_ / nanoseconds_per_byte_at_1_baud);
}

// The line never rests while a message waits for room. That the room will be there in time can thus be told at once:
// as much will have left as the line carries until then.
bool Port::queue(ByteSpan message, GpsTime ready, Nanoseconds patience) {
    std::size_t waiting = 0;
    // The last first: what went before one that has begun has left.
    for (auto m = messages_.rbegin(); m != messages_.rend(); ++m) {
        waiting += m->bytes.size();
        if (m->start > ready) continue;
        waiting -= departed(*m, ready);
        break;
    }
    const Nanoseconds wait = std::clamp(patience, Nanoseconds(0), longest_wait);
    const auto carried = static_cast<std::size_t>(wait.count() * baud_ / nanoseconds_per_byte_at_1_baud);
    const bool fits = message.size() <= buffer_bytes_ && waiting + message.size() <= buffer_bytes_ + carried;
    if (message.empty() || !fits) return message.empty();
    const GpsTime start = std::max(ready, line_free_);
    messages_.push_back({{message.begin(), message.end()}, ready, start, 0});
    line_free_ = start + line_time(message.size());
    pending_ += message.size();
    return true;
}

Bytes Port::take(GpsTime now) {
    Bytes out;
    while (!messages_.empty()) {
        Message& m = messages_.front();
        const std::size_t gone = std::max(m.taken, departed(m, now));
        out.insert(out.end(), m.bytes.begin() + static_cast<std::ptrdiff_t>(m.taken),
                   m.bytes.begin() + static_cast<std::ptrdiff_t>(gone));
        m.taken = gone;
        if (gone < m.bytes.size()) break;
        messages_.pop_front();
    }
    pending_ -= out.size();
    return out;
}

GpsTime Port::between_bytes(GpsTime now) const {
    for (const Message& m : messages_) {
        if (now <= m.start) return now;
        const std::size_t gone = departed(m, now);
        if (gone == m.bytes.size()) continue;
        return m.start + line_time(gone) == now ? now : m.start + line_time(gone + 1);
    }
    return now;
}

void Port::set_baud(std::uint32_t baud, GpsTime now) {
    for (Message& m : messages_) {
        const std::size_t gone = std::max(m.taken, departed(m, now));
        m.bytes.erase(m.bytes.begin(), m.bytes.begin() + static_cast<std::ptrdiff_t>(gone));
        pending_ -= gone - m.taken;
        m.taken = 0;
    }
    baud_ = baud;
    line_free_ = now;
    std::erase_if(messages_, [](const Message& m) { return m.bytes.empty(); });
    for (Message& m : messages_) {
        m.start = std::max(m.ready, line_free_);
        line_free_ = m.start + line_time(m.bytes.size());
    }
}

void Port::clear() {
    messages_.clear();
    pending_ = 0;
    line_free_ = {};
}

std::optional<GpsTime> Port::drained_at() const {
    if (messages_.empty()) return std::nullopt;
    return line_free_;
}

std::optional<GpsTime> Port::message_ends_at() const {
    if (messages_.empty()) return std::nullopt;
    return messages_.front().start + line_time(messages_.front().bytes.size());
}

}  // namespace skyloop::firmware
