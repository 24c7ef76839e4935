#include "firmware/port_unit.hpp"

#include <algorithm>

#include "firmware/config/config_keys.hpp"

namespace skyloop::firmware {
namespace {

constexpr std::uint32_t usb_full_speed = 12'000'000, i2c_fast_mode = 400'000;

}  // namespace

std::uint32_t configured_baud(const ConfigStore& store, PortId port) {
    const auto of_uart = [&store](std::uint32_t item) {
        return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(store.value(item), slowest_baud, fastest_baud));
    };
    switch (port) {
        case PortId::uart1:
            return of_uart(key::uart1_baudrate);
        case PortId::uart2:
            return of_uart(key::uart2_baudrate);
        case PortId::usb:
            return usb_full_speed;
        case PortId::i2c:
        case PortId::spi:
            return i2c_fast_mode;
    }
    return 0;
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
