#include "study/analysis/signal_strength.hpp"

#include <algorithm>
#include <cmath>

namespace skyloop {

void RunningStatistics::add(double value) {
    ++n_;
    const double from_old = value - mean_;
    mean_ += from_old / static_cast<double>(n_);
    squares_ += from_old * (value - mean_);
}

double RunningStatistics::std() const { return n_ < 2 ? 0 : std::sqrt(squares_ / static_cast<double>(n_ - 1)); }

void SignalStrengthByElevation::add(const SignalReport& report) {
    constexpr double rounding = 1e-9;  // degrees that the way through radians may cost
    const double degrees = report.elevation.deg() + rounding;
    const double cn0 = report.cn0.value();
    if (!(degrees >= 0 && degrees <= 90 + 2 * rounding) || !(cn0 > 0) || !std::isfinite(cn0)) return;
    bins_[std::min(static_cast<std::size_t>(degrees / bin_width_deg), bins - 1)].add(cn0);
}

bool SignalStrengthByElevation::empty() const {
    return std::all_of(bins_.begin(), bins_.end(), [](const RunningStatistics& bin) { return bin.n() == 0; });
}

}  // namespace skyloop
