#include "study/analysis/distribution.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace skyloop {
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

}  // namespace skyloop
