/// Confidence intervals of shares and of percentiles, all of 95 %, none of which asks for a normal distribution.
/// What one number tells of another, by ranks alone: units and shapes of distributions do not matter.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace skyloop::inline campaigns {

/// The confidence of every interval of a report.
inline constexpr double report_confidence = 0.95;

struct Interval {
    double low = 0, high = 0;
};

/// How many of some trials passed.
struct TrialCount {
    std::size_t passed = 0, trials = 0;
};

/// Wilson's score interval for the chance of passing, 0 … 1 (E. B. Wilson, "Probable inference, the law of succession,
/// and statistical inference", JASA 22, 1927). Its mean coverage is near 95 %; of a chance near 0 or 1 it can be lower.
/// Without trials 0 … 1.
Interval wilson_interval(TrialCount count);

/// The exact interval of Clopper and Pearson ("The use of confidence or fiducial limits illustrated in the case of the
/// binomial", Biometrika 26, 1934), 0 … 1: of every chance covered at least 95 %. Without trials 0 … 1.
Interval clopper_pearson_interval(TrialCount count);

/// A rate with the interval that suits its counts.
struct Rate {
    TrialCount count;
    Interval interval;
    bool exact = false;  ///< the interval is Clopper and Pearson's, otherwise Wilson's
    /// The share that passed, 0 … 1; 0 without trials.
    [[nodiscard]] double share() const {
        return count.trials == 0 ? 0 : static_cast<double>(count.passed) / static_cast<double>(count.trials);
    }
};

/// With fewer than this many trials on either side the exact interval is taken: there Wilson's can cover less than it
/// says (Brown, Cai and DasGupta, "Interval estimation for a binomial proportion", Statistical Science 16, 2001,
/// section 4).
inline constexpr std::size_t few_trials = 5;
Rate rate_of(TrialCount count);

/// An interval for a percentile whose ends are values of the sample themselves. An end that the sample is too small
/// for is open.
struct PercentileInterval {
    std::optional<double> low, high;          ///< unit of the sample
    std::size_t low_rank = 0, high_rank = 0;  ///< which smallest values those are, 1 … n; 0: open
};

/// The interval for the `share` quantile (0 … 1) of the law that `sorted` (ascending) was drawn from, of whatever shape
/// (H. A. David and H. N. Nagaraja, "Order Statistics", 3rd edition, section 7.1): at most 2.5 % of all samples lie
/// wholly on either side, so it covers at least 95 %; with open ends too.
PercentileInterval percentile_interval(std::span<const double> sorted, double share);

/// The fewest values for which percentile_interval() has two ends; `share` between 0 and 1.
std::size_t fewest_values_for(double share);

/// Half the height of the band around an empirical distribution function that holds the whole true one in 95 % of
/// samples of `n` values (Dvoretzky, Kiefer and Wolfowitz, 1956; P. Massart, Annals of Probability 18, 1990); at
/// most 1.
double distribution_band(std::size_t n);

/// The rank of each value among all, 1 … n; equal values share the mean of their ranks.
std::vector<double> average_ranks(std::span<const double> values);

/// Whether two series rise and fall together.
struct RankCorrelation {
    double rho = 0;      ///< −1 … 1
    double p_value = 1;  ///< how often series without a relation are as far from 0, 0 … 1
    std::size_t n = 0;
};

/// Spearman's rank correlation of pairs (C. Spearman, 1904), ties by average ranks, its p-value by Student's
/// distribution with n − 2 degrees of freedom (M. G. Kendall, "Rank Correlation Methods", section 5.14), which is rough
/// below ten pairs. Nothing for fewer than three pairs, series of different lengths or one that is constant.
std::optional<RankCorrelation> spearman_correlation(std::span<const double> x, std::span<const double> y);

/// Whether some group of values lies higher than another.
struct GroupTest {
    double h = 0;         ///< Kruskal and Wallis's statistic, corrected for ties
    double p_value = 1;   ///< how often groups of one law differ as much, 0 … 1
    double strength = 0;  ///< ε² = H / (n − 1): 0 none, 1 all of the differences of rank are between groups
    std::size_t groups = 0, n = 0;
};

/// The test of W. H. Kruskal and W. A. Wallis ("Use of ranks in one-criterion variance analysis", JASA 47, 1952), its
/// p-value by χ² with one degree of freedom fewer than groups. `group` gives the number of each value's group; groups
/// without a value do not count. Nothing for fewer than two groups, three values or where all values are equal.
std::optional<GroupTest> kruskal_wallis_test(std::span<const double> values, std::span<const std::size_t> group);

}  // namespace skyloop::inline campaigns
