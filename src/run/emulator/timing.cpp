#include "run/emulator/timing.hpp"

#include <sys/prctl.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <ctime>

namespace skyloop::inline run {
namespace {

using namespace std::chrono_literals;

GpsTime on_grid(GpsTime earliest, Nanoseconds period) {
    const Nanoseconds past = earliest.time_since_epoch() % period;
    return past > 0ns ? earliest - past + period : earliest - past;
}

Nanoseconds possible(Nanoseconds period) { return std::max<Nanoseconds>(period, 1ms); }

}  // namespace

void EpochGrid::start(GpsTime now, Nanoseconds period) {
    period_ = possible(period);
    last_.reset();
    next_ = on_grid(now, period_);
}

void EpochGrid::follow(GpsTime now, Nanoseconds period) {
    if (possible(period) == period_) return;
    period_ = possible(period);
    next_ = on_grid(last_ ? std::max(now, *last_ + 1ns) : now, period_);
}

void EpochGrid::pass() {
    last_ = next_;
    next_ += period_;
}

namespace {

constexpr std::int64_t second_ns = 1'000'000'000;

// 1 ms keeps the byte rate smooth from 9600 to 921600 bit/s; without bytes only the client's opening is to be seen.
constexpr double busy_tick_ns = 1e6, idle_tick_ns = 5e6;

}  // namespace

void Pacer::rest() {
    constexpr timespec twenty_ms{0, 20'000'000};
    nanosleep(&twenty_ms, nullptr);
}

Nanoseconds SourcePacer::tick(bool bytes_pending) const {
    return Nanoseconds(std::llround(bytes_pending ? busy_tick_ns : idle_tick_ns));
}

RealtimePacer::RealtimePacer(GpsTime start, std::int64_t start_steady_ns, double speed)
    : start_(start), start_ns_(start_steady_ns), speed_(speed) {
    // The default slack lets the kernel wake us 50 µs late to save power.
    prctl(PR_SET_TIMERSLACK, 1UL);
}

std::int64_t RealtimePacer::due_ns(GpsTime time) const {
    return start_ns_ + std::llround(static_cast<double>((time - start_).count()) / speed_);
}

void RealtimePacer::set_speed(double speed, GpsTime now) {
    start_ns_ = due_ns(now);
    start_ = now;
    speed_ = speed;
}

void RealtimePacer::resume(GpsTime now) {
    if (paused()) {
        start_ns_ = steady_clock_ns();
        start_ = now;
    }
    Pacer::resume(now);
}

std::optional<Nanoseconds> RealtimePacer::wait_until(GpsTime time) {
    const std::int64_t due = due_ns(time);
    const timespec deadline{due / second_ns, due % second_ns};
    if (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &deadline, nullptr) == EINTR) return std::nullopt;
    return Nanoseconds(std::max<std::int64_t>(0, steady_clock_ns() - due));
}

Nanoseconds RealtimePacer::tick(bool bytes_pending) const {
    return Nanoseconds(std::llround((bytes_pending ? busy_tick_ns : idle_tick_ns) * speed_));
}

std::int64_t RealtimePacer::monotonic_ns(GpsTime) const { return steady_clock_ns(); }

void LatenessHistogram::add(Nanoseconds lateness) {
    const double ms = static_cast<double>(lateness.count()) / 1e6;
    const auto bin = std::upper_bound(bounds_ms.begin(), bounds_ms.end(), ms) - bounds_ms.begin();
    ++counts_[static_cast<std::size_t>(bin)];
    largest_ = std::max(largest_, lateness);
    ++epochs_;
    sum_ms_ += ms;
}

double LatenessHistogram::mean_ms() const { return epochs_ == 0 ? 0 : sum_ms_ / static_cast<double>(epochs_); }

}  // namespace skyloop::inline run
