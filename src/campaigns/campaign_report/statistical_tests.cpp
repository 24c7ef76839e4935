#include "campaigns/campaign_report/statistical_tests.hpp"

#include <boost/math/special_functions/beta.hpp>
#include <boost/math/special_functions/gamma.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace skyloop::inline campaigns {
namespace {

// Doubles all the way: the same bytes whatever the width of long double.
using PlainDoubles = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

constexpr double one_side = (1 - report_confidence) / 2;
// The 97.5 % quantile of the standard normal distribution.
constexpr double normal_975 = 1.959963984540054;

// P(X <= k) of a binomial law of n trials (Abramowitz and Stegun 26.5.24, by the regularised incomplete beta function).
double binomial_at_most(std::size_t k, std::size_t n, double chance) {
    if (k >= n) return 1;
    return boost::math::ibetac(static_cast<double>(k) + 1, static_cast<double>(n - k), chance, PlainDoubles());
}

// The fewest k of 0 … n with P(X <= k) > bound; P grows with k.
std::size_t fewest_above(double bound, std::size_t n, double chance) {
    std::size_t low = 0, high = n;
    while (low < high) {
        const std::size_t middle = low + (high - low) / 2;
        if (binomial_at_most(middle, n, chance) > bound)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

}  // namespace

Interval wilson_interval(TrialCount count) {
    if (count.trials == 0) return {0, 1};
    const auto n = static_cast<double>(count.trials);
    const double share = static_cast<double>(count.passed) / n;
    constexpr double z2 = normal_975 * normal_975;
    const double middle = (share + z2 / (2 * n)) / (1 + z2 / n);
    const double half = normal_975 * std::sqrt(share * (1 - share) / n + z2 / (4 * n * n)) / (1 + z2 / n);
    // The ends at no and at all trials passed are 0 and 1 by the formula; rounding must not move them.
    return {count.passed == 0 ? 0 : std::max(0.0, middle - half),
            count.passed == count.trials ? 1 : std::min(1.0, middle + half)};
}

Interval clopper_pearson_interval(TrialCount count) {
    if (count.trials == 0) return {0, 1};
    const auto passed = static_cast<double>(count.passed);
    const auto failed = static_cast<double>(count.trials - count.passed);
    Interval interval{0, 1};
    if (count.passed > 0) interval.low = boost::math::ibeta_inv(passed, failed + 1, one_side, PlainDoubles());
    if (count.passed < count.trials)
        interval.high = boost::math::ibeta_inv(passed + 1, failed, 1 - one_side, PlainDoubles());
    return interval;
}

Rate rate_of(TrialCount count) {
    const bool exact = std::min(count.passed, count.trials - count.passed) < few_trials;
    return {count, exact ? clopper_pearson_interval(count) : wilson_interval(count), exact};
}

// With X the number of values below the quantile: it lies left of the l-th smallest value when X < l, right of the u-th
// when X >= u.
PercentileInterval percentile_interval(std::span<const double> sorted, double share) {
    PercentileInterval interval;
    const std::size_t n = sorted.size();
    if (n == 0) return interval;
    // The largest l with P(X <= l − 1) <= 2.5 %.
    interval.low_rank = fewest_above(one_side, n, share);
    // The smallest u with P(X <= u − 1) >= 97.5 %; at u = n + 1 there is no value.
    std::size_t high = interval.low_rank;
    std::size_t beyond = n + 1;
    while (high < beyond) {
        const std::size_t middle = high + (beyond - high) / 2;
        if (middle > 0 && binomial_at_most(middle - 1, n, share) >= 1 - one_side)
            beyond = middle;
        else
            high = middle + 1;
    }
    interval.high_rank = high > n ? 0 : high;
    if (interval.low_rank > 0) interval.low = sorted[interval.low_rank - 1];
    if (interval.high_rank > 0) interval.high = sorted[interval.high_rank - 1];
    return interval;
}

// One end needs share^n <= 2.5 %, the other (1 − share)^n <= 2.5 %.
std::size_t fewest_values_for(double share) {
    return static_cast<std::size_t>(std::ceil(std::log(one_side) / std::log(std::max(share, 1 - share))));
}

double distribution_band(std::size_t n) {
    if (n == 0) return 1;
    return std::min(1.0, std::sqrt(std::log(2 / (1 - report_confidence)) / (2 * static_cast<double>(n))));
}

namespace {

using RankTestPolicy = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

// Two-sided p-value of Student's t with `freedom` degrees of freedom (Abramowitz and Stegun 26.7.1, 26.5.27).
double student_p_value(double t, double freedom) {
    return boost::math::ibeta(freedom / 2, 0.5, freedom / (freedom + t * t), RankTestPolicy());
}

// P(χ² > h) (Abramowitz and Stegun 26.4.19).
double chi_squared_p_value(double h, double freedom) {
    return boost::math::gamma_q(freedom / 2, std::max(h, 0.0) / 2, RankTestPolicy());
}

struct RankSum {
    double sum = 0;
    std::size_t n = 0;
};

}  // namespace

std::vector<double> average_ranks(std::span<const double> values) {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
    std::vector<double> ranks(values.size());
    for (std::size_t first = 0, last = 0; first < order.size(); first = last) {
        while (last < order.size() && values[order[last]] == values[order[first]])
            ++last;
        for (std::size_t i = first; i < last; ++i)
            ranks[order[i]] = static_cast<double>(first + 1 + last) / 2;
    }
    return ranks;
}

std::optional<RankCorrelation> spearman_correlation(std::span<const double> x, std::span<const double> y) {
    if (x.size() != y.size() || x.size() < 3) return std::nullopt;
    const std::vector<double> rank_x = average_ranks(x);
    const std::vector<double> rank_y = average_ranks(y);
    const double mean = static_cast<double>(x.size() + 1) / 2;
    double xx = 0, yy = 0, xy = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        xx += (rank_x[i] - mean) * (rank_x[i] - mean);
        yy += (rank_y[i] - mean) * (rank_y[i] - mean);
        xy += (rank_x[i] - mean) * (rank_y[i] - mean);
    }
    if (xx == 0 || yy == 0) return std::nullopt;
    RankCorrelation result{std::clamp(xy / std::sqrt(xx * yy), -1.0, 1.0), 0, x.size()};
    const auto freedom = static_cast<double>(x.size() - 2);
    const double rest = 1 - result.rho * result.rho;
    if (rest > 0) result.p_value = student_p_value(result.rho * std::sqrt(freedom / rest), freedom);
    return result;
}

std::optional<GroupTest> kruskal_wallis_test(std::span<const double> values, std::span<const std::size_t> group) {
    if (values.size() != group.size() || values.size() < 3) return std::nullopt;
    const std::vector<double> ranks = average_ranks(values);
    const auto n = static_cast<double>(values.size());
    std::map<std::size_t, RankSum> sums;
    double spread = 0;  // of the ranks about their mean, which ties make smaller
    for (std::size_t i = 0; i < values.size(); ++i) {
        RankSum& of_group = sums[group[i]];
        of_group.sum += ranks[i] - (n + 1) / 2;
        ++of_group.n;
        spread += (ranks[i] - (n + 1) / 2) * (ranks[i] - (n + 1) / 2);
    }
    if (sums.size() < 2 || spread == 0) return std::nullopt;
    double between = 0;
    for (const auto& [number, of_group] : sums)
        between += of_group.sum * of_group.sum / static_cast<double>(of_group.n);
    // The share of the spread that lies between the groups, times n − 1: the corrected H of the paper's section 3.
    GroupTest test{(n - 1) * between / spread, 1, between / spread, sums.size(), values.size()};
    test.p_value = chi_squared_p_value(test.h, static_cast<double>(sums.size() - 1));
    return test;
}

}  // namespace skyloop::inline campaigns
