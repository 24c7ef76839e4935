#include "study/analysis/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>
#include <unsupported/Eigen/FFT>

#include "base/geo/local_frame.hpp"

namespace skyloop {
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

}  // namespace skyloop
