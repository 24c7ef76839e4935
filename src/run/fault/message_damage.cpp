#include "detail/message_damage.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/core/can_frame.hpp"
#include "receiver/protocol/casic_frame.hpp"
#include "receiver/protocol/mavlink.hpp"
#include "receiver/protocol/msp.hpp"
#include "receiver/protocol/ubx_frame.hpp"
#include "receiver/protocol/unicore_frame.hpp"

namespace skyloop::inline run {
namespace {

// Longer than the gaps that drivers leave within a message, shorter than what clients wait for an answer.
constexpr Nanoseconds longest_silence = std::chrono::milliseconds(100);
// What a message of some kilobytes takes at the usual speeds.
constexpr Nanoseconds longest_message = std::chrono::seconds(1);
// The last message of an epoch finds the next one in the epoch that follows, at 1 Hz too.
constexpr Nanoseconds longest_lateness = std::chrono::seconds(2);
constexpr double longest_pause_s = 1e9;

constexpr StreamProtocols wire_protocols{
    .msp = true, .mavlink = true, .sbf = true, .unicore = true, .can = true, .casic = true};

constexpr std::size_t rtcm3_payload_at = 3;  // RTCM 10403.3, section 4.2
constexpr std::size_t sbf_payload_at = 8;    // after sync, CRC, ID and length

// Of all sources.
double bursts_per_s(const WireDirection& direction) {
    double sum = 0;
    for (const GarbageBursts& bursts : direction.garbage)
        sum += bursts.per_s;
    return sum;
}

// A character that may stand within a sentence (NMEA 0183, 5.1: those reserved for other things are not).
bool is_sentence_character(std::uint8_t c) {
    return c >= 0x20 && c <= 0x7E && std::string_view("$*!\\^~").find(static_cast<char>(c)) == std::string_view::npos;
}

std::size_t drawn_index(RandomStream& random, std::size_t count) {
    return std::min(static_cast<std::size_t>(random.uniform() * static_cast<double>(count)), count - 1);
}

// Of the bytes from `first` on, before `end`.
void turn_bit_within(Bytes& message, std::size_t first, std::size_t end, RandomStream& random) {
    if (first >= end) return;
    const std::size_t at = first + drawn_index(random, end - first);
    message[at] = static_cast<std::uint8_t>(message[at] ^ (1U << drawn_index(random, 8)));
}

void turn_bit_from(Bytes& message, std::size_t first, RandomStream& random) {
    turn_bit_within(message, first, message.size(), random);
}

// Behind the head, which says where the frame ends, as far as the checksum: it does not cover a signature.
void turn_bit_of_mavlink(Bytes& frame, RandomStream& random) {
    const std::size_t head = frame[0] == mavlink_v1_start ? mavlink_v1_head_size : mavlink_v2_head_size;
    const std::size_t signature = head + frame[1] + mavlink_crc_size;
    turn_bit_within(frame, head, std::min(signature, frame.size()), random);
}

// The sentence stays one line of printable characters, so that only its checksum tells.
void turn_bit_of_sentence(Bytes& message, RandomStream& random) {
    const auto star = std::find(message.rbegin(), message.rend(), '*');
    const auto star_at =
        static_cast<std::size_t>(std::distance(star, message.rend())) - (star == message.rend() ? 0 : 1);
    for (int attempt = 0; attempt < 16 && star_at > 1; ++attempt) {
        std::uint8_t& character = message[1 + drawn_index(random, star_at - 1)];
        const auto turned = static_cast<std::uint8_t>(character ^ (1U << drawn_index(random, 7)));
        if (!is_sentence_character(turned)) continue;
        character = turned;
        return;
    }
    // The lowest bit of the checksum's last digit always gives another digit, or none.
    if (star_at + 2 < message.size()) message[star_at + 2] ^= 1U;
}

void turn_bit_of_unicore(Bytes& message, RandomStream& random) {
    if (message[0] == unicore_sync_1) return turn_bit_from(message, unicore_head_size, random);
    turn_bit_of_sentence(message, random);
}

// CAN's own CRC is the adapter's affair: what arrives wrong is a byte of data, which the transfer's CRC covers.
void turn_bit_of_can(Bytes& line, RandomStream& random) {
    const std::string text = to_string(line);
    auto frame = parse_slcan_line(std::string_view(text).substr(0, text.find('\r')));
    if (!frame || frame->size < 2) return;
    const std::size_t at = drawn_index(random, frame->size - 1U);
    frame->data[at] = static_cast<std::uint8_t>(frame->data[at] ^ (1U << drawn_index(random, 8)));
    line = to_bytes(slcan_line(*frame));
}

}  // namespace

void spoil_checksum(Bytes& message, StreamKind kind, RandomStream& random) {
    switch (kind) {
        case StreamKind::ubx:
            return turn_bit_from(message, ubx_head_size, random);
        case StreamKind::rtcm3:
            return turn_bit_from(message, rtcm3_payload_at, random);
        case StreamKind::sbf:
            return turn_bit_from(message, sbf_payload_at, random);
        case StreamKind::nmea:
            return turn_bit_of_sentence(message, random);
        case StreamKind::msp:
            return turn_bit_from(message, message[1] == 'M' ? msp_v1_head_size : msp_v2_head_size, random);
        case StreamKind::mavlink:
            return turn_bit_of_mavlink(message, random);
        case StreamKind::unicore:
            return turn_bit_of_unicore(message, random);
        case StreamKind::can:
            return turn_bit_of_can(message, random);
        case StreamKind::casic:
            return turn_bit_from(message, casic_head_size, random);
        case StreamKind::noise:
        case StreamKind::command:
            return;
    }
}

MessageDamage::MessageDamage(std::uint64_t seed, std::string_view stream)
    : splitter_(wire_protocols), corrections_(seed, std::string(stream)) {
    for (const std::string_view of : {"checksum", "place", "truncation", "merging", "duplication", "reordering",
                                      "garbage", "garbage content", "jitter", "garbage source", "message loss"})
        random_.emplace_back(seed, std::string(stream) + "." + std::string(of));
    threshold_ = next_threshold();
}

// Standard exponential.
double MessageDamage::next_threshold() { return -std::log1p(-random_[garbages].uniform()); }

bool MessageDamage::happens(double probability, Draw draw) {
    return probability > 0 && random_[draw].uniform() < probability;
}

// From 1 to size − 1: something is left on either side.
std::size_t MessageDamage::place_within(std::size_t size) { return 1 + drawn_index(random_[places], size - 1); }

void MessageDamage::set(const WireDirection& direction, GpsTime now, std::vector<TimedBytes>& out) {
    integral_ += bursts_per_s(direction_) * difference(now, integrated_to_).value();
    integrated_to_ = now;
    direction_ = direction;
    corrections_.set(direction.corrections);
    active_ = direction.message_loss > 0 || direction.checksum_errors > 0 || direction.truncation > 0 ||
              direction.merging > 0 || direction.duplication > 0 || direction.reordering > 0 ||
              !direction.garbage.empty() || direction.jitter.value() > 0 ||
              direction.corrections != CorrectionConditions{};
    if (direction.garbage.empty()) {
        integral_ = 0;
        bursts_due_.clear();
    }
    if (direction.merging <= 0) head_is_missing_ = false;
    while (direction.corrections.delay.value() <= 0 && !delayed_.empty())
        deliver_delayed(now, out);
    if (direction.reordering <= 0) emit_late(now, out);
    if (!active_) flush(now, out);
}

void MessageDamage::flush(GpsTime now, std::vector<TimedBytes>& out) {
    for (StreamPiece& piece : splitter_.finish())
        out.push_back({now, std::move(piece.bytes)});
    arrivals_.clear();
    undecided_ = 0;
}

void MessageDamage::clear() {
    counts_.bytes_lost += waiting();
    std::vector<TimedBytes> lost;
    flush({}, lost);
    late_.clear();
    delayed_.clear();
    delayed_bytes_ = 0;
    head_is_missing_ = false;
    bursts_due_.clear();
}

void MessageDamage::put(ByteSpan bytes, GpsTime now, std::vector<TimedBytes>& out) {
    if (bytes.empty()) return;
    last_byte_ = now;
    if (!arrivals_.empty() && arrivals_.back().time == now)
        arrivals_.back().count += bytes.size();
    else
        arrivals_.push_back({now, bytes.size()});
    undecided_ += bytes.size();
    for (StreamPiece& piece : splitter_.feed(bytes))
        decide(std::move(piece), now, out);
}

void MessageDamage::decide(StreamPiece piece, GpsTime now, std::vector<TimedBytes>& out) {
    forget_arrivals(piece.bytes.size());
    if (piece.kind == StreamKind::noise)
        emit(std::move(piece.bytes), now, out);
    else if (piece.kind == StreamKind::rtcm3 && corrections_.active())
        correct(std::move(piece), now, out);
    else
        damage(std::move(piece), now, out);
    for (const int bytes : std::exchange(bursts_due_, {}))
        emit_garbage(bytes, now, out);
}

void MessageDamage::forget_arrivals(std::size_t count) {
    undecided_ -= count;
    while (count > 0) {
        const std::size_t part = std::min(count, arrivals_.front().count);
        arrivals_.front().count -= part;
        count -= part;
        if (arrivals_.front().count == 0) arrivals_.pop_front();
    }
}

void MessageDamage::correct(StreamPiece piece, GpsTime now, std::vector<TimedBytes>& out) {
    const std::size_t size = piece.bytes.size();
    Bytes told = corrections_.change(piece.bytes, now);
    if (told.empty()) counts_.bytes_lost += size;
    if (told != piece.bytes) ++counts_.messages_changed;
    if (told.empty()) return;
    piece.bytes = std::move(told);
    const Seconds delay = direction_.corrections.delay;
    if (delay.value() <= 0) return damage(std::move(piece), now, out);
    const GpsTime due = advanced(now, delay);
    delayed_bytes_ += piece.bytes.size();
    delayed_.push_back({delayed_.empty() ? due : std::max(due, delayed_.back().due), std::move(piece)});
}

void MessageDamage::deliver_delayed(GpsTime now, std::vector<TimedBytes>& out) {
    StreamPiece piece = std::move(delayed_.front().piece);
    delayed_.pop_front();
    delayed_bytes_ -= piece.bytes.size();
    damage(std::move(piece), now, out);
}

void MessageDamage::cut(Bytes& message) {
    if (message.size() < 2) return;
    const std::size_t left = place_within(message.size());
    counts_.bytes_lost += message.size() - left;
    message.resize(left);
}

void MessageDamage::damage(StreamPiece piece, GpsTime now, std::vector<TimedBytes>& out) {
    Bytes message = std::move(piece.bytes);
    const std::size_t size = message.size();
    if (happens(direction_.message_loss, losses)) {
        counts_.bytes_lost += size;
        ++counts_.messages_changed;
        return;
    }
    bool changed = false;
    if (happens(direction_.checksum_errors, checksums)) {
        spoil_checksum(message, piece.kind, random_[places]);
        ++counts_.bits_turned;
        changed = true;
    }
    if (std::exchange(head_is_missing_, false) && size > 1) {
        const std::size_t missing = place_within(size);
        counts_.bytes_lost += missing;
        message.erase(message.begin(), message.begin() + static_cast<std::ptrdiff_t>(missing));
    }
    if (happens(direction_.truncation, truncations)) cut(message);
    if (happens(direction_.merging, mergings)) {
        cut(message);
        head_is_missing_ = true;
    }
    const bool twice = happens(direction_.duplication, doublings);
    const bool after_next = late_.empty() && happens(direction_.reordering, orders);
    if (changed || twice || after_next || message.size() != size) ++counts_.messages_changed;
    if (twice) {
        counts_.bytes_inserted += message.size();
        const Bytes copy = message;
        message.insert(message.end(), copy.begin(), copy.end());
    }
    if (after_next) {
        late_ = std::move(message);
        late_since_ = now;
        return;
    }
    emit(std::move(message), now, out);
    emit_late(now, out);
}

void MessageDamage::emit(Bytes bytes, GpsTime now, std::vector<TimedBytes>& out) {
    const Seconds jitter = direction_.jitter.value() > 0 ? direction_.jitter * random_[jitters].normal() : Seconds(0);
    out.push_back({now, std::move(bytes), jitter});
}

void MessageDamage::emit_late(GpsTime now, std::vector<TimedBytes>& out) {
    if (!late_.empty()) emit(std::exchange(late_, {}), now, out);
}

// Poisson processes together are one, each of whose bursts is of a source by its share of the rate.
int MessageDamage::drawn_burst() {
    double left = random_[sources].uniform() * bursts_per_s(direction_);
    for (const GarbageBursts& bursts : direction_.garbage)
        if ((left -= bursts.per_s) < 0) return bursts.bytes;
    return direction_.garbage.back().bytes;
}

void MessageDamage::emit_garbage(int bytes, GpsTime now, std::vector<TimedBytes>& out) {
    Bytes burst(static_cast<std::size_t>(bytes));
    for (std::uint8_t& byte : burst)
        byte = static_cast<std::uint8_t>(random_[contents].bits() >> 56);
    counts_.bytes_inserted += burst.size();
    ++counts_.garbage_bursts;
    out.push_back({now, std::move(burst)});
}

void MessageDamage::give_up_waiting(GpsTime now, std::vector<TimedBytes>& out) {
    for (StreamPiece& piece : splitter_.finish())
        decide(std::move(piece), now, out);
}

std::optional<GpsTime> MessageDamage::patience_ends() const {
    if (undecided_ == 0) return std::nullopt;
    return std::min(last_byte_ + longest_silence, arrivals_.front().time + longest_message);
}

std::optional<GpsTime> MessageDamage::garbage_at() const {
    if (direction_.garbage.empty()) return std::nullopt;
    const double pause = std::max(0.0, (threshold_ - integral_) / bursts_per_s(direction_));
    return advanced(integrated_to_, Seconds(std::min(pause, longest_pause_s)));
}

void MessageDamage::garbage_happens(GpsTime at, std::vector<TimedBytes>& out) {
    integral_ = 0;
    integrated_to_ = at;
    threshold_ = next_threshold();
    const int bytes = drawn_burst();
    if (undecided_ > 0)
        bursts_due_.push_back(bytes);
    else
        emit_garbage(bytes, at, out);
}

void MessageDamage::advance(GpsTime now, std::vector<TimedBytes>& out) {
    constexpr GpsTime never = GpsTime::max();
    for (;;) {
        const GpsTime patience = patience_ends().value_or(never), garbage = garbage_at().value_or(never);
        const GpsTime late = late_.empty() ? never : late_since_ + longest_lateness;
        const GpsTime delayed = delayed_.empty() ? never : delayed_.front().due;
        const GpsTime first = std::min({patience, garbage, late, delayed});
        if (first > now) return;
        if (first == patience)
            give_up_waiting(first, out);
        else if (first == delayed)
            deliver_delayed(first, out);
        else if (first == late)
            emit_late(first, out);
        else
            garbage_happens(first, out);
    }
}

std::optional<GpsTime> MessageDamage::next_at() const {
    std::optional<GpsTime> next = patience_ends();
    if (const auto garbage = garbage_at()) next = std::min(next.value_or(GpsTime::max()), *garbage);
    if (!late_.empty()) next = std::min(next.value_or(GpsTime::max()), late_since_ + longest_lateness);
    if (!delayed_.empty()) next = std::min(next.value_or(GpsTime::max()), delayed_.front().due);
    return next;
}

}  // namespace skyloop::inline run
