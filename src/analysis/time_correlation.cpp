#include "skyloop/analysis/time_correlation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "skyloop/analysis/statistics.hpp"

namespace skyloop {

FixTimes fix_times(const FixSeries& series) {
    FixTimes times;
    const bool stamped = series.interval && std::all_of(series.samples.begin(), series.samples.end(),
                                                        [](const FixSample& s) { return !s.has_fix || s.time; });
    times.in_seconds = series.interval.has_value();
    if (series.interval) times.step = series.interval->value();
    std::optional<GpsTime> first;
    for (std::size_t i = 0; i < series.samples.size(); ++i) {
        const FixSample& sample = series.samples[i];
        if (!sample.has_fix) continue;
        if (!first) first = sample.time;
        times.at.push_back(stamped ? difference(*sample.time, *first).value() : static_cast<double>(i) * times.step);
    }
    return times;
}

TimeCorrelation::TimeCorrelation(const FixTimes& times, std::span<const double> values) : step_(times.step) {
    const std::optional<SampleStatistics> statistics = sample_statistics(values);
    const std::size_t count = std::min(times.at.size(), values.size());
    points_.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        points_.push_back({times.at[i], values[i] - statistics->mean});
        variance_ += points_.back().value * points_.back().value / static_cast<double>(count);
    }
    std::stable_sort(points_.begin(), points_.end(), [](const Point& a, const Point& b) { return a.time < b.time; });
}

std::optional<LaggedCorrelation> TimeCorrelation::at_lag(double lag) const {
    const double slack = step_ / 2 * (1 + 1e-9);
    if (!(lag > step_ / 2) || !(variance_ > 0)) return std::nullopt;
    LaggedCorrelation result;
    double sum = 0;
    std::size_t j = 0;
    for (const Point& point : points_) {
        const double target = point.time + lag;
        const auto distance = [&](std::size_t k) { return std::abs(points_[k].time - target); };
        while (j + 1 < points_.size() && distance(j + 1) < distance(j))
            ++j;
        if (distance(j) > slack) continue;
        sum += point.value * points_[j].value;
        ++result.pairs;
    }
    constexpr std::size_t least_share = 4;
    if (result.pairs == 0 || result.pairs * least_share < points_.size()) return std::nullopt;
    result.value = sum / static_cast<double>(result.pairs) / variance_;
    return result;
}

bool TimeCorrelation::has_gaps() const {
    for (std::size_t i = 1; i < points_.size(); ++i)
        if (std::abs(points_[i].time - points_[i - 1].time - step_) > step_ / 2) return true;
    return false;
}

std::optional<double> TimeCorrelation::time_to_1_e() const {
    constexpr double level = 1 / std::numbers::e;
    constexpr std::size_t steps_per_doubling = 32;
    double lag_before = 0, value_before = 1;
    for (std::size_t k = 1; k <= points_.size() / 2; k += std::max<std::size_t>(1, k / steps_per_doubling)) {
        const double lag = static_cast<double>(k) * step_;
        const std::optional<LaggedCorrelation> r = at_lag(lag);
        if (!r) continue;
        if (r->value <= level)
            return lag_before + (lag - lag_before) * (value_before - level) / (value_before - r->value);
        lag_before = lag;
        value_before = r->value;
    }
    return std::nullopt;
}

std::optional<double> TimeCorrelation::epoch_noise() const {
    std::vector<double> differences;
    for (std::size_t i = 1; i < points_.size(); ++i)
        if (std::abs(points_[i].time - points_[i - 1].time - step_) <= step_ / 2)
            differences.push_back(points_[i].value - points_[i - 1].value);
    if (differences.size() < 2) return std::nullopt;
    return sample_statistics(differences)->std / std::numbers::sqrt2;
}

}  // namespace skyloop
