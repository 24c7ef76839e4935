#include "run/emulator/lateness.hpp"

#include <algorithm>

namespace skyloop {

void LatenessHistogram::add(Nanoseconds lateness) {
    const double ms = static_cast<double>(lateness.count()) / 1e6;
    const auto bin = std::upper_bound(bounds_ms.begin(), bounds_ms.end(), ms) - bounds_ms.begin();
    ++counts_[static_cast<std::size_t>(bin)];
    largest_ = std::max(largest_, lateness);
    latest_ = lateness;
    ++epochs_;
    sum_ms_ += ms;
}

double LatenessHistogram::mean_ms() const { return epochs_ == 0 ? 0 : sum_ms_ / static_cast<double>(epochs_); }

}  // namespace skyloop
