// What a damaged wire does to bytes: many wait for their time, the end of a stall, or the throughput of the wire.
#include "run/fault/wire_damage.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/core/bytes.hpp"
#include "base/time/gps_time.hpp"
#include "detail/message_damage.hpp"

namespace skyloop::inline run {

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

namespace {

constexpr double longest_service_s = 1e9;  // far beyond any run, and far within 64 bits of nanoseconds

// Rounded up, so that no byte leaves at the instant at which its service begins.
Nanoseconds service_time(double bytes, double rate) {
    const double seconds = std::min(bytes / rate, longest_service_s);
    return Nanoseconds(static_cast<std::int64_t>(std::ceil(seconds * 1e9)));
}

}  // namespace

GpsTime WireQueue::leaves(std::uint64_t number) const {
    return anchor_ + service_time(static_cast<double>(number) - progress_, *rate_);
}

void WireQueue::begin_service(GpsTime at, double progress) {
    anchor_ = at;
    progress_ = progress;
    served_ = 0;
}

double WireQueue::progress_at(GpsTime now) const {
    if (!rate_ || stalled_ || runs_.empty()) return 0;
    const GpsTime begun = std::max(free_at(), runs_.front().due);
    if (begun > now) return 0;
    const double before = served_ == 0 && begun == anchor_ ? progress_ : 0;
    return std::clamp(before + difference(now, begun).value() * *rate_, 0.0, 1 - 1e-9);
}

void WireQueue::set(bool stalled, std::optional<double> bytes_per_s, GpsTime now) {
    if (stalled == stalled_ && bytes_per_s == rate_) return;
    begin_service(now, progress_at(now));
    stalled_ = stalled;
    rate_ = bytes_per_s;
}

void WireQueue::hasten(GpsTime now) {
    for (Run& run : runs_)
        run.due = std::min(run.due, now);
}

bool WireQueue::lets_through(GpsTime due, GpsTime now) const {
    return runs_.empty() && !stalled_ && !rate_ && due <= now;
}

std::size_t WireQueue::push(ByteSpan bytes, GpsTime due, std::size_t capacity) {
    const std::size_t count = std::min(bytes.size(), capacity - std::min(capacity, bytes_.size()));
    if (count == 0) return bytes.size();
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
    if (!runs_.empty()) due = std::max(due, runs_.back().due);
    if (!runs_.empty() && runs_.back().due == due)
        runs_.back().count += count;
    else
        runs_.push_back({due, count});
    return bytes.size() - count;
}

// How many bytes of the first run have left by `now`. The estimate may be wrong by a byte; leaves() decides.
std::size_t WireQueue::served_of(const Run& run, GpsTime now) const {
    const std::uint64_t most = served_ + run.count;
    const double estimate = std::floor(difference(now, anchor_).value() * *rate_ + progress_);
    std::uint64_t number =
        estimate < static_cast<double>(most) ? static_cast<std::uint64_t>(std::max(0.0, estimate)) : most;
    number = std::max(number, served_);
    while (number < most && leaves(number + 1) <= now)
        ++number;
    while (number > served_ && leaves(number) > now)
        --number;
    return static_cast<std::size_t>(number - served_);
}

void WireQueue::release(GpsTime now, Bytes& out) {
    if (stalled_) return;
    while (!runs_.empty() && runs_.front().due <= now) {
        Run& run = runs_.front();
        std::size_t count = run.count;
        if (rate_) {
            if (run.due > free_at()) begin_service(run.due, 0);
            count = served_of(run, now);
            served_ += count;
        }
        if (count == 0) return;
        const auto end = bytes_.begin() + static_cast<std::ptrdiff_t>(count);
        out.insert(out.end(), bytes_.begin(), end);
        bytes_.erase(bytes_.begin(), end);
        run.count -= count;
        if (run.count > 0) return;
        runs_.pop_front();
    }
}

std::optional<GpsTime> WireQueue::next_at() const {
    if (stalled_ || runs_.empty()) return std::nullopt;
    const GpsTime due = runs_.front().due;
    if (!rate_) return due;
    if (due <= free_at()) return leaves(served_ + 1);
    return due + service_time(1, *rate_);
}

std::size_t WireQueue::clear() {
    const std::size_t count = bytes_.size();
    bytes_.clear();
    runs_.clear();
    return count;
}

namespace {

// Beyond these nothing changes that anyone could see, and sums stay within their types.
constexpr double longest_held_s = 1e6;
constexpr double most_bursts_per_s = 1000;
constexpr int most_burst_bytes = 4096;
constexpr double least_bytes_per_s = 1e-3, most_bytes_per_s = 1e9;

double probability_of(double value) { return std::isfinite(value) ? std::clamp(value, 0.0, 1.0) : 0; }

double amount_of(double value, double most) { return std::isfinite(value) ? std::clamp(value, 0.0, most) : 0; }

// All sources together have no more bursts than a single one may.
void make_sensible(std::vector<GarbageBursts>& garbage) {
    double sum = 0;
    for (GarbageBursts& bursts : garbage) {
        bursts = {amount_of(bursts.per_s, most_bursts_per_s), std::clamp(bursts.bytes, 0, most_burst_bytes)};
        if (bursts.bytes == 0) bursts.per_s = 0;
        sum += bursts.per_s;
    }
    std::erase_if(garbage, [](const GarbageBursts& bursts) { return bursts.per_s <= 0; });
    if (sum <= most_bursts_per_s) return;
    for (GarbageBursts& bursts : garbage)
        bursts.per_s *= most_bursts_per_s / sum;
}

WireDirection sensible(WireDirection direction) {
    for (double* probability :
         {&direction.byte_loss, &direction.message_loss, &direction.bit_errors, &direction.checksum_errors,
          &direction.truncation, &direction.merging, &direction.duplication, &direction.reordering})
        *probability = probability_of(*probability);
    make_sensible(direction.garbage);
    direction.delay = Seconds(amount_of(direction.delay.value(), longest_held_s));
    direction.jitter = Seconds(amount_of(direction.jitter.value(), longest_held_s));
    if (direction.bytes_per_s && !std::isfinite(*direction.bytes_per_s)) direction.bytes_per_s.reset();
    if (direction.bytes_per_s && *direction.bytes_per_s < least_bytes_per_s) {
        direction.bytes_per_s.reset();
        direction.stalled = true;
    }
    if (direction.bytes_per_s) direction.bytes_per_s = std::min(*direction.bytes_per_s, most_bytes_per_s);
    return direction;
}

}  // namespace

class WireDamage::State {
public:
    State(std::uint64_t seed, const std::string& stream)
        : messages_(seed, stream), losses_(seed, stream + ".byte loss"), turns_(seed, stream + ".bit errors") {}

    void set(const WireDirection& direction, GpsTime now);
    void put(ByteSpan bytes, GpsTime now);
    Bytes take(GpsTime now);
    [[nodiscard]] std::optional<GpsTime> next_at() const;
    [[nodiscard]] std::size_t waiting() const { return messages_.waiting() + queue_.size() + ready_.size(); }
    [[nodiscard]] WireDamageCounts counts() const;

private:
    void advance(GpsTime now);
    void enter(std::vector<TimedBytes>& pieces);
    void enter(TimedBytes piece);
    void damage(Bytes& bytes);
    void release(GpsTime now);
    void lose_everything();

    WireDirection direction_;
    bool sound_ = true;  // nothing is wrong, and so nothing is held
    GpsTime now_ = GpsTime::min();
    MessageDamage messages_;
    RandomStream losses_, turns_;
    WireQueue queue_;
    GpsTime last_due_ = GpsTime::min();
    Bytes ready_;
    GpsTime ready_since_{};
    WireDamageCounts counts_;
};

void WireDamage::State::set(const WireDirection& given, GpsTime now) {
    const WireDirection direction = sensible(given);
    if (direction == direction_) return;
    now_ = std::max(now_, now);
    advance(now_);
    direction_ = direction;
    sound_ = direction == WireDirection{};
    if (direction.dead) lose_everything();
    std::vector<TimedBytes> freed;
    // What is dead has no messages to damage.
    messages_.set(direction.dead ? WireDirection{} : direction, now_, freed);
    queue_.set(direction.stalled, direction.bytes_per_s, now_);
    if (direction.delay.value() <= 0 && direction.jitter.value() <= 0) {
        queue_.hasten(now_);
        last_due_ = now_;
    }
    enter(freed);
    release(now_);
}

void WireDamage::State::put(ByteSpan bytes, GpsTime now) {
    if (bytes.empty()) return;
    now_ = std::max(now_, now);
    if (sound_) {
        if (ready_.empty()) ready_since_ = now_;
        ready_.insert(ready_.end(), bytes.begin(), bytes.end());
        return;
    }
    advance(now_);
    if (direction_.dead) {
        counts_.bytes_lost += bytes.size();
        return;
    }
    std::vector<TimedBytes> pieces;
    if (messages_.active())
        messages_.put(bytes, now_, pieces);
    else
        pieces.push_back({now_, Bytes(bytes.begin(), bytes.end())});
    enter(pieces);
    release(now_);
}

Bytes WireDamage::State::take(GpsTime now) {
    now_ = std::max(now_, now);
    advance(now_);
    return std::exchange(ready_, {});
}

void WireDamage::State::advance(GpsTime now) {
    if (sound_) return;
    if (messages_.active()) {
        std::vector<TimedBytes> pieces;
        messages_.advance(now, pieces);
        enter(pieces);
    }
    release(now);
}

void WireDamage::State::release(GpsTime now) {
    const bool was_empty = ready_.empty();
    queue_.release(now, ready_);
    if (was_empty && !ready_.empty()) ready_since_ = now;
}

void WireDamage::State::enter(std::vector<TimedBytes>& pieces) {
    for (TimedBytes& piece : pieces)
        enter(std::move(piece));
}

void WireDamage::State::enter(TimedBytes piece) {
    damage(piece.bytes);
    if (piece.bytes.empty()) return;
    // How much room there is depends on what has left by then.
    release(piece.time);
    const Seconds delay(std::max(0.0, (direction_.delay + piece.jitter).value()));
    const GpsTime due = std::max(last_due_, advanced(piece.time, delay));
    last_due_ = due;
    if (!queue_.lets_through(due, piece.time)) {
        counts_.bytes_overrun += queue_.push(piece.bytes, due, WireDamage::capacity);
        return;
    }
    if (ready_.empty()) ready_since_ = piece.time;
    ready_.insert(ready_.end(), piece.bytes.begin(), piece.bytes.end());
}

void WireDamage::State::damage(Bytes& bytes) {
    if (direction_.byte_loss > 0)
        counts_.bytes_lost +=
            std::erase_if(bytes, [&](std::uint8_t) { return losses_.uniform() < direction_.byte_loss; });
    if (direction_.bit_errors <= 0) return;
    for (std::uint8_t& byte : bytes)
        for (unsigned bit = 0; bit < 8; ++bit)
            if (turns_.uniform() < direction_.bit_errors) {
                byte = static_cast<std::uint8_t>(byte ^ (1U << bit));
                ++counts_.bits_turned;
            }
}

void WireDamage::State::lose_everything() {
    messages_.clear();
    counts_.bytes_lost += queue_.clear();
}

std::optional<GpsTime> WireDamage::State::next_at() const {
    if (!ready_.empty()) return ready_since_;
    const auto whole = messages_.next_at(), queued = queue_.next_at();
    if (whole && queued) return std::min(*whole, *queued);
    return whole ? whole : queued;
}

WireDamageCounts WireDamage::State::counts() const {
    WireDamageCounts sum = messages_.counts();
    sum.bytes_lost += counts_.bytes_lost;
    sum.bytes_overrun += counts_.bytes_overrun;
    sum.bits_turned += counts_.bits_turned;
    return sum;
}

WireDamage::WireDamage(std::uint64_t seed, std::string_view stream)
    : state_(std::make_unique<State>(seed, std::string(stream))) {}
WireDamage::~WireDamage() = default;
WireDamage::WireDamage(WireDamage&&) noexcept = default;
WireDamage& WireDamage::operator=(WireDamage&&) noexcept = default;

void WireDamage::set(const WireDirection& direction, GpsTime now) { state_->set(direction, now); }
void WireDamage::put(ByteSpan bytes, GpsTime now) { state_->put(bytes, now); }
Bytes WireDamage::take(GpsTime now) { return state_->take(now); }
std::optional<GpsTime> WireDamage::next_at() const { return state_->next_at(); }
std::size_t WireDamage::waiting() const { return state_->waiting(); }
WireDamageCounts WireDamage::counts() const { return state_->counts(); }

}  // namespace skyloop::inline run
