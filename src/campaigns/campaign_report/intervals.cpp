#include "campaigns/campaign_report/intervals.hpp"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>

namespace skyloop {
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

}  // namespace skyloop
