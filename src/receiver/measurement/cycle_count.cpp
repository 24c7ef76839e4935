#include "detail/cycle_count.hpp"

#include <cmath>
#include <numbers>

namespace skyloop {
namespace {

constexpr double quiet_phase = 0.2;            // rad
constexpr double span_of_starts = 100;         // cycles, to either side: near the range, as u-blox starts its count
constexpr double share_of_single_slips = 0.8;  // the others are double

}  // namespace

double slips_per_second(const CarrierLoop& loop, Angle jitter) {
    if (!(jitter.rad() > quiet_phase)) return 0;
    return 2 * loop.bandwidth.value() * std::erfc(std::numbers::pi / 2 / (std::numbers::sqrt2 * jitter.rad()));
}

void CycleCount::start(bool half_unknown) {
    cycles_ = std::floor((2 * starts_.uniform() - 1) * span_of_starts);
    const bool half = starts_.uniform() < 0.5;
    if (half_unknown && half) cycles_ += 0.5;
}

bool CycleCount::slip(double expected, bool half_cycle_resolved) {
    // Two numbers each time, so that a weaker signal has the slips of a stronger one and more.
    const double happens = slips_.uniform(), kind = slips_.uniform();
    if (!(happens < -std::expm1(-expected))) return false;
    const double direction = kind < 0.5 ? -1 : 1;
    const double cycles = std::abs(2 * kind - 1) < share_of_single_slips ? 1 : 2;
    cycles_ += direction * cycles * (half_cycle_resolved ? 1.0 : 0.5);
    return true;
}

bool CycleCount::resolve_half_cycle() {
    const double whole = std::floor(cycles_);
    if (whole == cycles_) return false;
    cycles_ = whole;
    return true;
}

}  // namespace skyloop
