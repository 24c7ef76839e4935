#include "run/emulator/faulty_wire.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace skyloop {
namespace {

bool is_sound(const WireDirection& direction, const WireDamage& damage) {
    return direction == WireDirection{} && damage.waiting() == 0;
}

constexpr Nanoseconds millisecond{1'000'000};

// The last one that has passed.
GpsTime whole_millisecond(GpsTime time) { return time - time.time_since_epoch() % millisecond; }

}  // namespace

FaultyWire::FaultyWire(std::uint64_t seed, std::size_t number)
    : to_client_(seed, fmt::format("wire{}.to_client", number)),
      to_receiver_(seed, fmt::format("wire{}.to_receiver", number)) {}

bool FaultyWire::damages_output() const { return !is_sound(conditions_.to_client, to_client_); }

void FaultyWire::set(const WireConditions& conditions, GpsTime now) {
    if (conditions == conditions_) return;
    to_client_.put(std::exchange(entering_, {}), now);
    if (conditions.line_break && !conditions_.line_break) break_begins_ = true;
    if (conditions.to_client != conditions_.to_client) to_client_.set(conditions.to_client, now);
    if (conditions.to_receiver != conditions_.to_receiver) to_receiver_.set(conditions.to_receiver, now);
    conditions_ = conditions;
}

// A break is one zero byte to a terminal's driver, and nothing else gets through while it lasts.
std::vector<firmware::Receiver::Sent> FaultyWire::to_client(std::vector<firmware::Receiver::Sent> sent, GpsTime now) {
    if (!sent.empty()) last_baud_ = sent.back().baud;
    const auto port = sent.empty() ? firmware::PortId::uart1 : sent.front().port;
    if (conditions_.line_break) {
        (void)to_client_.take(now);  // it would want to be looked at for ever
        if (!std::exchange(break_begins_, false)) return {};
        return {{port, last_baud_, Bytes{0}}};
    }
    if (!damages_output()) return sent;
    for (const firmware::Receiver::Sent& piece : sent)
        entering_.insert(entering_.end(), piece.bytes.begin(), piece.bytes.end());
    if (now == whole_millisecond(now)) to_client_.put(std::exchange(entering_, {}), now);
    Bytes out = to_client_.take(now);
    if (out.empty()) return {};
    return {{port, last_baud_, std::move(out)}};
}

Bytes FaultyWire::to_receiver(Bytes bytes, GpsTime now) {
    if (is_sound(conditions_.to_receiver, to_receiver_)) return bytes;
    to_receiver_.put(bytes, now);
    return to_receiver_.take(now);
}

std::optional<GpsTime> FaultyWire::next_at(GpsTime now) const {
    std::optional<GpsTime> next;
    if (damages_output()) next = whole_millisecond(now + millisecond);
    for (const auto& held : {to_client_.next_at(), to_receiver_.next_at()})
        if (held && (!next || *held < *next)) next = held;
    return next;
}

}  // namespace skyloop
