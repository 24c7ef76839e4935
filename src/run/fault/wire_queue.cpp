#include "detail/wire_queue.hpp"

#include <algorithm>
#include <cmath>

namespace skyloop {
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

}  // namespace skyloop
