#include "run/emulator/pacer.hpp"

#include <sys/prctl.h>
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <ctime>

namespace skyloop {
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

}  // namespace skyloop
