#include "run/emulator/link.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/core/bytes.hpp"

namespace skyloop::inline run {
namespace {

constexpr std::uint32_t any_baud = 9600;    // of a garbler that is never used
constexpr std::size_t driver_bytes = 4096;  // of input, as a terminal's driver holds (N_TTY_BUF_SIZE of Linux)
constexpr std::int64_t second_in_ns = 1'000'000'000;
constexpr std::int64_t usb_bits_per_s = 12'000'000;  // full speed (USB 2.0, section 4.2.1)

// Rounded up: at the end of it the stop bit has come whole.
Nanoseconds byte_time(PortSpeed speed) {
    const std::int64_t bits = speed ? SerialFormat{}.bits_per_byte() : 8;
    const std::int64_t rate = speed ? std::max<std::int64_t>(*speed, 1) : usb_bits_per_s;
    return Nanoseconds((bits * second_in_ns + rate - 1) / rate);
}

}  // namespace

Link::Link(std::unique_ptr<Transport> transport, PortSpeed speed, InputPace pace)
    : transport_(std::move(transport)),
      to_client_(speed.value_or(any_baud), speed.value_or(any_baud)),
      to_receiver_(speed.value_or(any_baud), speed.value_or(any_baud)),
      pace_(pace) {
    tell_speed(speed);
}

void Link::tell_speed(PortSpeed speed) {
    if (!speed || told_ == speed) return;
    told_ = speed;
    transport_->set_receiver_baud(*speed);
}

Bytes Link::heard_by_client(ByteSpan bytes, std::uint32_t receiver_baud, std::uint32_t client_baud, bool at_rest) {
    to_client_.set_bauds(receiver_baud, client_baud);
    Bytes heard = to_client_.pass(bytes);
    if (at_rest) {
        const Bytes rest = to_client_.idle();
        heard.insert(heard.end(), rest.begin(), rest.end());
    }
    return heard;
}

void Link::send(ByteSpan bytes, PortSpeed speed, bool at_rest) {
    tell_speed(speed);
    // With nothing to say and nothing on its way the system need not be asked: this is called every millisecond.
    if (bytes.empty() && (!at_rest || to_client_.resting())) return;
    const LineState line = transport_->line();
    connected_ = line.connected && plugged_;
    if (!connected_) {
        counters_.bytes_unheard += bytes.size();
        return;
    }
    const std::uint32_t receiver_baud = speed.value_or(any_baud);
    const std::uint32_t client_baud = speed ? line.baud.value_or(receiver_baud) : any_baud;
    const Bytes heard = heard_by_client(bytes, receiver_baud, client_baud, at_rest);
    if (heard.empty()) return;
    const std::size_t taken = transport_->write(heard);
    counters_.bytes_out += taken;
    // Who has gone has not read too slowly.
    if (taken < heard.size())
        (transport_->line().connected ? counters_.bytes_lost : counters_.bytes_unheard) += heard.size() - taken;
    if (client_baud != receiver_baud) counters_.bytes_garbled += taken;
}

void Link::set_plugged(bool plugged) {
    if (std::exchange(plugged_, plugged) != plugged) transport_->set_plugged(plugged);
}

void Link::look(GpsTime now) {
    if (SimulatedEnd* end = transport_->simulated_end()) end->tell_time(now);
    const LineState line = transport_->line();
    connected_ = line.connected && plugged_;
    // What is left in the driver makes the client wait, as a slow line does.
    if (waiting_ >= driver_bytes) return;
    Bytes bytes = transport_->read();
    if (!plugged_) bytes.clear();
    may_rest_ = bytes.empty();
    if (bytes.empty()) return;
    waiting_ += bytes.size();
    incoming_.push_back({std::move(bytes), line.baud, now, 0});
}

Bytes Link::take_piece(const Piece& piece, PortSpeed speed, std::size_t count) {
    const ByteSpan bytes = ByteSpan(piece.bytes).subspan(piece.taken, count);
    const std::uint32_t receiver_baud = speed.value_or(any_baud);
    to_receiver_.set_bauds(speed ? piece.speed.value_or(receiver_baud) : any_baud, receiver_baud);
    return to_receiver_.pass(bytes);
}

Nanoseconds Link::byte_time_of(const Piece& piece, PortSpeed port) {
    // A wire without a speed of its own is as fast as the port.
    return byte_time(port ? PortSpeed(piece.speed.value_or(*port)) : PortSpeed());
}

// The bytes of one write come without a gap; when none are left and none came, the line rests.
std::optional<Bytes> Link::rest(GpsTime now) {
    if (!may_rest_ || to_receiver_.resting() || (pace_ == InputPace::line && now < rests_at_)) return std::nullopt;
    Bytes heard = to_receiver_.idle();
    counters_.bytes_in += heard.size();
    return heard;
}

std::optional<GpsTime> Link::next_arrival(PortSpeed speed) const {
    if (pace_ == InputPace::at_once) return std::nullopt;
    if (incoming_.empty()) return to_receiver_.resting() ? std::nullopt : std::optional(rests_at_);
    const Piece& piece = incoming_.front();
    return std::max(line_free_, piece.read_at) + byte_time_of(piece, speed);
}

std::optional<Bytes> Link::receive(PortSpeed speed, GpsTime now) {
    if (incoming_.empty()) return rest(now);
    Piece& piece = incoming_.front();
    std::size_t count = speed ? 1 : piece.bytes.size() - piece.taken;
    if (pace_ == InputPace::line) {
        const Nanoseconds each = byte_time_of(piece, speed);
        const GpsTime begins = std::max(line_free_, piece.read_at);
        const auto arrived = (now - begins) / each;
        if (now < begins || arrived < 1) return std::nullopt;
        count = std::min(count, static_cast<std::size_t>(arrived));
        line_free_ = begins + each * static_cast<std::int64_t>(count);
        rests_at_ = line_free_ + each;
    }
    Bytes heard = take_piece(piece, speed, count);
    piece.taken += count;
    waiting_ -= count;
    if (piece.taken == piece.bytes.size()) incoming_.pop_front();
    counters_.bytes_in += heard.size();
    return heard;
}

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

}  // namespace skyloop::inline run
