#include "run/emulator/epoch_grid.hpp"

#include <algorithm>

namespace skyloop {
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

}  // namespace skyloop
