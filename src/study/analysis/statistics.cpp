#include "study/analysis/statistics.hpp"

#include <fmt/format.h>

#include <unsupported/Eigen/FFT>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <vector>

#include "base/geo/local_frame.hpp"

namespace skyloop::inline study {
namespace {

std::vector<double> ascending(std::span<const double> values) {
    std::vector<double> sorted(values.begin(), values.end());
    std::sort(sorted.begin(), sorted.end());
    return sorted;
}

// Both sorted; equal values are stepped over together, so that ties do not count as a difference.
double kolmogorov_smirnov(const std::vector<double>& a, const std::vector<double>& b) {
    double largest = 0;
    for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
        const double value = std::min(a[i], b[j]);
        while (i < a.size() && a[i] <= value)
            ++i;
        while (j < b.size() && b[j] <= value)
            ++j;
        largest = std::max(largest, std::abs(static_cast<double>(i) / static_cast<double>(a.size()) -
                                             static_cast<double>(j) / static_cast<double>(b.size())));
    }
    return largest;
}

struct CommonBins {
    double from = 0, width = 0;
    std::size_t count = 1;
};

CommonBins common_bins(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> both(a.size() + b.size());
    std::merge(a.begin(), a.end(), b.begin(), b.end(), both.begin());
    const double lower = both[both.size() / 4];
    const double upper = both[both.size() * 3 / 4];
    constexpr double far = 10;
    double from = both.front(), to = both.back();
    if (upper > lower) {
        from = std::max(from, lower - far * (upper - lower));
        to = std::min(to, upper + far * (upper - lower));
    }
    if (!(to > from)) return {from, 0, 1};
    constexpr double most = 500;
    const auto n = static_cast<double>(std::min(a.size(), b.size()));
    // Half of the values being equal leaves no interquartile range: then a fiftieth of the whole range.
    const double wanted = upper > lower ? 2 * (upper - lower) / std::cbrt(n) : (to - from) / 50;
    const double count = std::clamp(std::ceil((to - from) / wanted), 2.0, most);
    return {from, (to - from) / count, static_cast<std::size_t>(count)};
}

std::vector<double> shares_in_bins(const std::vector<double>& values, const CommonBins& bins) {
    std::vector<double> shares(bins.count);
    const auto last = static_cast<double>(bins.count - 1);
    for (const double v : values) {
        const double place = bins.width > 0 ? std::clamp(std::floor((v - bins.from) / bins.width), 0.0, last) : 0;
        shares[static_cast<std::size_t>(place)] += 1 / static_cast<double>(values.size());
    }
    return shares;
}

}  // namespace

std::optional<DistributionDistance> distribution_distance(std::span<const double> a, std::span<const double> b) {
    if (a.empty() || b.empty()) return std::nullopt;
    const std::vector<double> of_a = ascending(a);
    const std::vector<double> of_b = ascending(b);
    const CommonBins bins = common_bins(of_a, of_b);
    const std::vector<double> share_a = shares_in_bins(of_a, bins);
    const std::vector<double> share_b = shares_in_bins(of_b, bins);
    DistributionDistance distance{0, bins.width, bins.count, kolmogorov_smirnov(of_a, of_b)};
    for (std::size_t i = 0; i < bins.count; ++i)
        distance.total_variation += std::abs(share_a[i] - share_b[i]) / 2;
    return distance;
}

namespace {

Geodetic mean_position(const FixSeries& series) {
    // From the first fix on, so that the sum stays small and its rounding does.
    std::optional<Eigen::Vector3d> first;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const FixSample& sample : series.samples) {
        if (!sample.has_fix) continue;
        const Eigen::Vector3d ecef = to_ecef(sample.position).vector();
        if (!first) first = ecef;
        sum += ecef - *first;
    }
    if (!first) return to_geodetic(Position<Ecef>(sum));
    return to_geodetic(Position<Ecef>(Eigen::Vector3d(*first + sum / static_cast<double>(series.fixes()))));
}

bool every_fix_has_truth(const FixSeries& series) {
    return std::all_of(series.samples.begin(), series.samples.end(),
                       [](const FixSample& s) { return !s.has_fix || s.truth.has_value(); });
}

}  // namespace

double sorted_quantile(std::span<const double> sorted, double share) {
    const double place = share * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

std::optional<SampleStatistics> sample_statistics(std::span<const double> values) {
    if (values.empty()) return std::nullopt;
    SampleStatistics s;
    s.n = values.size();
    const auto n = static_cast<double>(s.n);
    s.mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
    double about_mean = 0;
    double about_zero = 0;
    for (const double v : values) {
        about_mean += (v - s.mean) * (v - s.mean);
        about_zero += v * v;
    }
    s.std = s.n > 1 ? std::sqrt(about_mean / (n - 1)) : 0;
    s.rms = std::sqrt(about_zero / n);
    std::vector<double> sorted(values.begin(), values.end());
    std::sort(sorted.begin(), sorted.end());
    s.min = sorted.front();
    s.max = sorted.back();
    s.median = sorted_quantile(sorted, 0.50);
    s.p95 = sorted_quantile(sorted, 0.95);
    return s;
}

PositionErrors position_errors(const FixSeries& series, const std::optional<Geodetic>& point) {
    PositionErrors errors;
    if (every_fix_has_truth(series)) {
        errors.reference = ReferenceKind::truth;
    } else {
        errors.reference = point ? ReferenceKind::given_point : ReferenceKind::own_mean;
        errors.point = point ? *point : mean_position(series);
    }
    std::optional<LocalFrame> frame;
    if (errors.point) frame.emplace(*errors.point);
    for (const FixSample& sample : series.samples) {
        if (!sample.has_fix) continue;
        if (!errors.point) frame.emplace(*sample.truth);
        const Eigen::Vector3d enu = frame->to_enu(to_ecef(sample.position)).vector();
        errors.east.push_back(enu.x());
        errors.north.push_back(enu.y());
        errors.up.push_back(enu.z());
        errors.horizontal.push_back(std::hypot(enu.x(), enu.y()));
        errors.spatial.push_back(enu.norm());
    }
    return errors;
}

// By the Wiener–Khinchin theorem: the sums over all lags cost no more than two Fourier transforms.
std::vector<double> lagged_products(std::span<const double> values, std::size_t max_lag) {
    std::size_t size = 4;  // the least that Eigen transforms of real numbers
    while (size < 2 * values.size())
        size <<= 1;
    std::vector<double> padded(size);
    std::copy(values.begin(), values.end(), padded.begin());
    Eigen::FFT<double> transform;
    std::vector<std::complex<double>> spectrum;
    transform.fwd(spectrum, padded);
    for (std::complex<double>& bin : spectrum)
        bin = std::norm(bin);
    transform.inv(padded, spectrum);
    std::vector<double> sums(std::min(max_lag + 1, values.size()));
    for (std::size_t lag = 0; lag < sums.size(); ++lag)
        sums[lag] = padded[lag];
    return sums;
}

std::optional<double> ComparisonPercent::agreement() const {
    return difference <= 100 ? std::optional(100 - difference) : std::nullopt;
}

std::string ComparisonPercent::text() const {
    const std::string told = fmt::format("difference {:.1f} %", difference);
    const auto agrees = agreement();
    return agrees ? told + fmt::format(", agreement {:.1f} %", *agrees) : told;
}

std::optional<ComparisonPercent> comparison_percent(const SampleStatistics& candidate,
                                                    const SampleStatistics& reference) {
    if (candidate.n == 0 || std::abs(reference.mean) < rounding_dust_m || reference.std < rounding_dust_m)
        return std::nullopt;
    ComparisonPercent result;
    result.mean_part = 100 * std::abs(candidate.mean - reference.mean) / std::abs(reference.mean);
    result.std_part = 100 * std::abs(candidate.std - reference.std) / reference.std;
    result.difference = (result.mean_part + result.std_part) / 2;
    result.mean_near_zero = std::abs(reference.mean) < reference.std / 4;
    return result;
}

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

}  // namespace skyloop::inline study
