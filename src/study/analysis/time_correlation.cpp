#include "study/analysis/time_correlation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "study/analysis/statistics.hpp"

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
        squares_ += points_.back().value * points_.back().value;
    }
    // What rounding leaves about the mean of constant values is no variance.
    if (!statistics || !(statistics->max > statistics->min)) squares_ = 0;
    std::stable_sort(points_.begin(), points_.end(), [](const Point& a, const Point& b) { return a.time < b.time; });
}

bool TimeCorrelation::enough(std::size_t pairs) const {
    constexpr std::size_t least_share = 4;
    return pairs > 0 && pairs * least_share >= points_.size();
}

// `rows` are those of the whole record. Without gaps they are the values, the pairs all that it has, and the scale
// is 1.
double TimeCorrelation::biased(double products, std::size_t pairs, double lag_steps, double rows) const {
    const double scale = (rows - lag_steps) * static_cast<double>(points_.size()) / (rows * static_cast<double>(pairs));
    // The few pairs that gaps leave may all be of the largest values.
    return std::clamp(products / squares_ * scale, -1.0, 1.0);
}

std::optional<LaggedCorrelation> TimeCorrelation::at_lag(double lag) const {
    const double slack = step_ / 2 * (1 + 1e-9);
    if (!(lag > step_ / 2) || !(squares_ > 0)) return std::nullopt;
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
    if (!enough(result.pairs)) return std::nullopt;
    const double variance = squares_ / static_cast<double>(points_.size());
    result.value = std::clamp(sum / static_cast<double>(result.pairs) / variance, -1.0, 1.0);
    return result;
}

// From the point before, one where no row is missing.
std::size_t TimeCorrelation::steps_before(std::size_t i) const {
    constexpr double most = 1e15;
    if (i == 0) return 0;
    const double apart = points_[i].time - points_[i - 1].time;
    return std::abs(apart - step_) <= step_ / 2 ? 1
                                                : static_cast<std::size_t>(std::llround(std::min(apart / step_, most)));
}

bool TimeCorrelation::has_gaps() const {
    for (std::size_t i = 1; i < points_.size(); ++i)
        if (steps_before(i) != 1) return true;
    return false;
}

// Of a row for each step, when pauses longer than any lag are cut to one that no pair spans.
std::size_t TimeCorrelation::places(std::size_t longest_lag) const {
    std::size_t count = 1;
    for (std::size_t i = 1; i < points_.size(); ++i)
        count += std::min(steps_before(i), longest_lag + 1);
    return count;
}

// Half of the series, or what does not take much more memory than it.
std::size_t TimeCorrelation::longest_lag() const {
    constexpr std::size_t places_per_value = 4, always_affordable = std::size_t{1} << 18;
    const std::size_t most = std::max(places_per_value * points_.size(), always_affordable);
    std::size_t lag = points_.size() / 2;
    while (lag > 1 && places(lag) > most)
        lag /= 2;
    return lag;
}

std::vector<LaggedCorrelation> TimeCorrelation::at_whole_steps() const {
    const std::size_t longest = longest_lag();
    std::vector<double> values(places(longest)), counts(values.size());
    std::size_t place = 0;
    double rows = 1;
    for (std::size_t i = 0; i < points_.size(); ++i) {
        place += std::min(steps_before(i), longest + 1);
        rows += static_cast<double>(steps_before(i));
        values[place] += points_[i].value;
        counts[place] += 1;
    }
    const std::vector<double> products = lagged_products(values, longest);
    const std::vector<double> pairs = has_gaps() ? lagged_products(counts, longest) : std::vector<double>();
    std::vector<LaggedCorrelation> all(products.size(), {1, points_.size()});
    for (std::size_t k = 1; k < all.size(); ++k) {
        // Counts, but for the rounding of the transforms.
        all[k].pairs = pairs.empty() ? points_.size() - k : static_cast<std::size_t>(std::max(pairs[k], 0.0) + 0.5);
        if (all[k].pairs > 0) all[k].value = biased(products[k], all[k].pairs, static_cast<double>(k), rows);
    }
    return all;
}

std::optional<double> TimeCorrelation::time_to_1_e() const {
    constexpr double level = 1 / std::numbers::e;
    if (!(squares_ > 0)) return std::nullopt;
    const std::vector<LaggedCorrelation> r = at_whole_steps();
    std::size_t before = 0;
    for (std::size_t k = 1; k < r.size(); ++k) {
        if (!enough(r[k].pairs)) continue;
        if (r[k].value <= level)
            return step_ * (static_cast<double>(before) + static_cast<double>(k - before) * (r[before].value - level) /
                                                              (r[before].value - r[k].value));
        before = k;
    }
    return std::nullopt;
}

std::optional<double> TimeCorrelation::epoch_noise() const {
    std::vector<double> differences;
    for (std::size_t i = 1; i < points_.size(); ++i)
        if (steps_before(i) == 1) differences.push_back(points_[i].value - points_[i - 1].value);
    if (differences.size() < 2) return std::nullopt;
    return sample_statistics(differences)->std / std::numbers::sqrt2;
}

}  // namespace skyloop
