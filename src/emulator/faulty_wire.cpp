#include "skyloop/emulator/faulty_wire.hpp"

#include <fmt/format.h>

namespace skyloop {
namespace {

bool is_sound(const WireDirection& direction, const WireDamage& damage) {
    return direction == WireDirection{} && damage.waiting() == 0;
}

}  // namespace

FaultyWire::FaultyWire(std::uint64_t seed, std::size_t number)
    : to_client_(seed, fmt::format("wire{}.to_client", number)),
      to_receiver_(seed, fmt::format("wire{}.to_receiver", number)) {}

void FaultyWire::set(const WireConditions& conditions, GpsTime now) {
    if (conditions == conditions_) return;
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
        if (!std::exchange(break_begins_, false)) return {};
        return {{port, last_baud_, Bytes{0}}};
    }
    if (is_sound(conditions_.to_client, to_client_)) return sent;
    for (const firmware::Receiver::Sent& piece : sent)
        to_client_.put(piece.bytes, now);
    Bytes out = to_client_.take(now);
    if (out.empty()) return {};
    return {{port, last_baud_, std::move(out)}};
}

Bytes FaultyWire::to_receiver(Bytes bytes, GpsTime now) {
    if (is_sound(conditions_.to_receiver, to_receiver_)) return bytes;
    to_receiver_.put(bytes, now);
    return to_receiver_.take(now);
}

std::optional<GpsTime> FaultyWire::next_at() const {
    const auto out = to_client_.next_at(), in = to_receiver_.next_at();
    if (!out || !in) return out ? out : in;
    return std::min(*out, *in);
}

}  // namespace skyloop
