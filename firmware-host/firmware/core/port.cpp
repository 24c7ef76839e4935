#include "firmware/core/port.hpp"

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

std::size_t Port::buffered(GpsTime now) const {
    std::size_t bytes = 0;
    // The last first: what went before one that has begun has left.
    for (auto m = messages_.rbegin(); m != messages_.rend(); ++m) {
        bytes += m->bytes.size() - departed(*m, now);
        if (m->start <= now) break;
    }
    return bytes;
}

// When so much has left that a message of that length may be generated.
GpsTime Port::turn_of(std::size_t bytes, GpsTime earliest) const {
    std::size_t may_stay = generated_ahead_ - std::min(generated_ahead_, bytes);
    for (auto m = messages_.rbegin(); m != messages_.rend(); ++m) {
        if (m->bytes.size() > may_stay) return std::max(earliest, m->start + line_time(m->bytes.size() - may_stay));
        may_stay -= m->bytes.size();
    }
    return earliest;
}

void Port::generate_until(GpsTime now) {
    while (!turns_.empty()) {
        const GpsTime at = turn_of(turns_.front().bytes.size(), turns_.front().since);
        if (at > now) return;
        enter(std::move(turns_.front().bytes), at);
        turns_.pop_front();
    }
}

void Port::enter(Bytes message, GpsTime at) {
    const GpsTime start = std::max(at, line_free_);
    line_free_ = start + line_time(message.size());
    pending_ += message.size();
    messages_.push_back({std::move(message), start, 0});
}

bool Port::queue(ByteSpan message, GpsTime now) {
    generate_until(now);
    if (message.empty()) return true;
    if (buffered(now) + message.size() > buffer_bytes_) return false;
    enter({message.begin(), message.end()}, now);
    return true;
}

bool Port::queue_in_turn(ByteSpan message, GpsTime now) {
    if (message.size() > buffer_bytes_) return false;
    if (message.empty()) return true;
    turns_.push_back({{message.begin(), message.end()}, now});
    generate_until(now);
    return true;
}

std::size_t Port::give_up_turns(GpsTime now) {
    generate_until(now);
    return std::erase_if(turns_, [now](const Turn& turn) { return turn.since < now; });
}

Bytes Port::take(GpsTime now) {
    generate_until(now);
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
    generate_until(now);
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
        m.start = line_free_;
        line_free_ = m.start + line_time(m.bytes.size());
    }
}

void Port::clear() {
    messages_.clear();
    turns_.clear();
    pending_ = 0;
    line_free_ = {};
}

std::optional<GpsTime> Port::drained_at() const {
    if (messages_.empty()) return std::nullopt;
    GpsTime last = line_free_;
    for (const Turn& turn : turns_)
        last += line_time(turn.bytes.size());
    return last;
}

std::optional<GpsTime> Port::message_ends_at() const {
    if (messages_.empty()) return std::nullopt;
    return messages_.front().start + line_time(messages_.front().bytes.size());
}

std::uint32_t bus_speed(PortId port) {
    constexpr std::uint32_t usb_full_speed = 12'000'000, i2c_fast_mode = 400'000;
    return port == PortId::usb ? usb_full_speed : i2c_fast_mode;
}

std::uint32_t factory_baud(PortId port, const BoardProfile& board) {
    constexpr std::uint32_t of_uart2 = 38'400;
    if (!is_uart(port)) return bus_speed(port);
    return port == PortId::uart2 ? of_uart2 : board.baud;
}

void Outbox::plan(GpsTime at, Action action) { plans_.emplace(at, std::move(action)); }

void Outbox::queue(PortId port, std::span<const ByteSpan> messages, GpsTime now) {
    PortUnit* unit = find_unit(units_, port);
    if (unit == nullptr) return;
    for (const ByteSpan message : messages)
        count(*unit, unit->transmit.queue(message, now));
}

void Outbox::queue_in_turn(PortId port, std::span<const ByteSpan> messages, GpsTime now) {
    PortUnit* unit = find_unit(units_, port);
    if (unit == nullptr) return;
    for (const ByteSpan message : messages)
        count(*unit, unit->transmit.queue_in_turn(message, now));
}

void Outbox::give_up_turns(PortUnit& unit, GpsTime now) {
    const std::size_t given_up = unit.transmit.give_up_turns(now);
    unit.totals.messages_out -= given_up;
    for (std::size_t i = 0; i < given_up; ++i)
        count(unit, false);
}

void Outbox::count(PortUnit& unit, bool queued) {
    int usage = 100;
    if (queued) {
        ++unit.totals.messages_out;
        usage = static_cast<int>(100 * unit.transmit.pending() / unit.transmit.buffer_bytes());
    } else {
        unit.status.transmit_full = unit.overflowed = true;
        ++unit.totals.messages_dropped;
        unit.totals.dropped_at_baud = unit.transmit.baud();
    }
    unit.status.usage_percent = usage;
    unit.status.peak_usage_percent = std::max(unit.status.peak_usage_percent, usage);
    unit.status.pending = unit.transmit.pending();
}

void Outbox::collect(GpsTime now, std::vector<Receiver::Sent>& sent) {
    for (PortUnit& unit : units_) {
        Bytes bytes = unit.transmit.take(now);
        unit.status.pending = unit.transmit.pending();
        if (bytes.empty()) continue;
        unit.status.bytes_out += bytes.size();
        const auto same = std::find_if(sent.rbegin(), sent.rend(), [&](const auto& s) { return s.port == unit.id; });
        if (same != sent.rend() && same->baud == unit.transmit.baud())
            same->bytes.insert(same->bytes.end(), bytes.begin(), bytes.end());
        else
            sent.push_back({unit.id, unit.transmit.baud(), std::move(bytes)});
    }
}

std::vector<Receiver::Sent> Outbox::run(GpsTime now) {
    std::vector<Receiver::Sent> sent;
    while (!plans_.empty() && plans_.begin()->first <= now) {
        const auto first = plans_.begin();
        const GpsTime at = first->first;
        const Action action = std::move(first->second);
        plans_.erase(first);
        collect(at, sent);
        action(at);
    }
    collect(now, sent);
    return sent;
}

std::optional<GpsTime> Outbox::drained_at() const {
    std::optional<GpsTime> last;
    const auto later = [&](std::optional<GpsTime> t) {
        if (t && (!last || *t > *last)) last = t;
    };
    for (const PortUnit& unit : units_)
        later(unit.transmit.drained_at());
    if (!plans_.empty()) later(plans_.rbegin()->first);
    return last;
}

std::optional<GpsTime> Outbox::next_at(PortId port) const {
    const PortUnit* unit = find_unit(units_, port);
    std::optional<GpsTime> next = unit == nullptr ? std::nullopt : unit->transmit.message_ends_at();
    if (!plans_.empty() && (!next || plans_.begin()->first < *next)) next = plans_.begin()->first;
    return next;
}

void Outbox::clear() {
    plans_.clear();
    for (PortUnit& unit : units_)
        unit.transmit.clear();
}

}  // namespace skyloop::firmware
