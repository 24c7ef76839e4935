// Intervals against tables made by others, and how often they hold.
#include "campaigns/campaign_report/statistical_tests.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/core/random.hpp"

namespace skyloop {
namespace {

struct RateOracle {
    TrialCount count;
    Interval wilson, exact;
};

// scipy 1.10.1: binomtest(passed, trials).proportion_ci(0.95, 'wilson' and 'exact').
const std::vector<RateOracle> rate_oracles{{{0, 10}, {0.0000000000, 0.2775327999}, {0.0000000000, 0.3084971078}},
                                           {{1, 10}, {0.0178762131, 0.4041500268}, {0.0025285785, 0.4450161170}},
                                           {{5, 10}, {0.2365930905, 0.7634069095}, {0.1870860284, 0.8129139716}},
                                           {{7, 20}, {0.1811918241, 0.5671457233}, {0.1539092048, 0.5921885345}},
                                           {{0, 1}, {0.0000000000, 0.7934506856}, {0.0000000000, 0.9750000000}},
                                           {{1, 1}, {0.2065493144, 1.0000000000}, {0.0250000000, 1.0000000000}},
                                           {{45, 50}, {0.7863976856, 0.9565242351}, {0.7818646336, 0.9667249064}},
                                           {{995, 1000}, {0.9883490446, 0.9978624645}, {0.9883705294, 0.9983745805}},
                                           {{1994, 2000}, {0.9934700849, 0.9986243701}, {0.9934817814, 0.9988982818}},
                                           {{10000, 10000}, {0.9996160016, 1.0000000000}, {0.9996311801, 1.0000000000}},
                                           {{9999, 10000}, {0.9994337311, 0.9999823473}, {0.9994429630, 0.9999974682}}};

TEST(Intervals, OfRatesAreThoseOfScipy) {
    for (const RateOracle& oracle : rate_oracles) {
        const Interval wilson = wilson_interval(oracle.count), exact = clopper_pearson_interval(oracle.count);
        EXPECT_NEAR(wilson.low, oracle.wilson.low, 1e-9) << oracle.count.passed;
        EXPECT_NEAR(wilson.high, oracle.wilson.high, 1e-9) << oracle.count.passed;
        EXPECT_NEAR(exact.low, oracle.exact.low, 1e-9) << oracle.count.passed;
        EXPECT_NEAR(exact.high, oracle.exact.high, 1e-9) << oracle.count.passed;
    }
}

TEST(Intervals, OfNoTrialsSayNothing) {
    for (const Interval& interval : {wilson_interval({}), clopper_pearson_interval({}), rate_of({}).interval}) {
        EXPECT_EQ(interval.low, 0);
        EXPECT_EQ(interval.high, 1);
    }
    EXPECT_EQ(rate_of({}).share(), 0);
}

TEST(Intervals, AreExactWhereCountsAreSmallOnEitherSide) {
    EXPECT_TRUE(rate_of({4, 1000}).exact);
    EXPECT_TRUE(rate_of({996, 1000}).exact);
    EXPECT_FALSE(rate_of({5, 1000}).exact);
    EXPECT_FALSE(rate_of({995, 1000}).exact);
    EXPECT_EQ(rate_of({996, 1000}).interval.low, clopper_pearson_interval({996, 1000}).low);
    EXPECT_EQ(rate_of({995, 1000}).interval.low, wilson_interval({995, 1000}).low);
}

struct RankOracle {
    std::size_t n;
    double share;
    std::size_t low, high;
};

// scipy 1.10.1, cdf = stats.binom(n, share).cdf(arange(n + 1)): low = sum(cdf <= 0.025), high the first u in 1 … n with
// cdf[u − 1] >= 0.975, 0 where there is none.
const std::vector<RankOracle> rank_oracles{
    {1, 0.50, 0, 0},           {1, 0.99, 1, 0},          {5, 0.50, 0, 0},         {6, 0.50, 1, 6},
    {6, 0.05, 0, 3},           {6, 0.95, 4, 0},          {10, 0.50, 2, 9},        {59, 0.50, 22, 38},
    {59, 0.95, 52, 0},         {100, 0.05, 1, 11},       {100, 0.50, 40, 61},     {100, 0.95, 90, 100},
    {367, 0.99, 359, 0},       {368, 0.99, 360, 368},    {1000, 0.05, 37, 65},    {1000, 0.50, 469, 532},
    {1000, 0.95, 936, 964},    {1000, 0.99, 983, 997},   {10000, 0.05, 458, 544}, {10000, 0.50, 4902, 5099},
    {10000, 0.95, 9457, 9543}, {10000, 0.99, 9880, 9920}};

TEST(Intervals, OfPercentilesEndAtTheRanksOfTheBinomialLaw) {
    for (const RankOracle& oracle : rank_oracles) {
        std::vector<double> sorted;
        for (std::size_t i = 1; i <= oracle.n; ++i)
            sorted.push_back(static_cast<double>(i) / 8);
        const PercentileInterval interval = percentile_interval(sorted, oracle.share);
        EXPECT_EQ(interval.low_rank, oracle.low) << oracle.n << " " << oracle.share;
        EXPECT_EQ(interval.high_rank, oracle.high) << oracle.n << " " << oracle.share;
        EXPECT_EQ(interval.low.has_value(), oracle.low > 0);
        EXPECT_EQ(interval.high.has_value(), oracle.high > 0);
        if (interval.low) {
            EXPECT_EQ(*interval.low, static_cast<double>(oracle.low) / 8);
        }
        if (interval.high) {
            EXPECT_EQ(*interval.high, static_cast<double>(oracle.high) / 8);
        }
    }
    EXPECT_FALSE(percentile_interval({}, 0.5).low || percentile_interval({}, 0.5).high);
}

TEST(Intervals, HaveTwoEndsFromTheNumberOfValuesOnThatIsTold) {
    for (const double share : {0.05, 0.5, 0.95, 0.99}) {
        const std::size_t enough = fewest_values_for(share);
        const std::vector<double> sorted(enough, 1.0);
        const PercentileInterval with = percentile_interval(sorted, share);
        const PercentileInterval without = percentile_interval(std::span(sorted).first(enough - 1), share);
        EXPECT_TRUE(with.low && with.high) << share;
        EXPECT_FALSE(without.low && without.high) << share;
    }
    EXPECT_EQ(fewest_values_for(0.99), 368u);  // 0.99^368 is the first power below 0.025
}

// How many per cent of drawn samples have the true chance in the interval that is told.
double rate_coverage(std::size_t trials, double chance, RandomStream& random) {
    constexpr std::size_t samples = 4000;
    std::size_t held = 0;
    for (std::size_t i = 0; i < samples; ++i) {
        TrialCount count{0, trials};
        for (std::size_t k = 0; k < trials; ++k)
            count.passed += random.uniform() < chance ? 1U : 0U;
        const Interval interval = rate_of(count).interval;
        held += interval.low <= chance && chance <= interval.high ? 1U : 0U;
    }
    return 100.0 * static_cast<double>(held) / samples;
}

// By the binomial law itself 94.3, 95.9, 94.5 and 96.7 % (summed with scipy); 4000 samples are within 1 % of that.
TEST(Intervals, OfRatesHoldIn93To97PercentOfSamples) {
    RandomStream random(1, "rate coverage");
    for (const auto& [trials, chance] :
         {std::pair<std::size_t, double>{100, 0.5}, {200, 0.8}, {400, 0.9}, {200, 0.95}}) {
        const double coverage = rate_coverage(trials, chance, random);
        EXPECT_GE(coverage, 93) << trials << " " << chance;
        EXPECT_LE(coverage, 97.5) << trials << " " << chance;
    }
}

// Values of an exponential law; its quantile is −log(1 − share).
double percentile_coverage(std::size_t n, double share, RandomStream& random) {
    constexpr std::size_t samples = 2000;
    const double truth = -std::log(1 - share);
    std::size_t held = 0;
    std::vector<double> values(n);
    for (std::size_t i = 0; i < samples; ++i) {
        for (double& value : values)
            value = -std::log(1 - random.uniform());
        std::sort(values.begin(), values.end());
        const PercentileInterval interval = percentile_interval(values, share);
        held += interval.low.value_or(0) <= truth && truth <= interval.high.value_or(1e9) ? 1U : 0U;
    }
    return 100.0 * static_cast<double>(held) / samples;
}

// By the binomial law 96.2, 96.0 and 96.2 %.
TEST(Intervals, OfPercentilesHoldIn93To97PercentOfSamples) {
    RandomStream random(1, "percentile coverage");
    for (const double share : {0.05, 0.5, 0.95}) {
        const double coverage = percentile_coverage(400, share, random);
        EXPECT_GE(coverage, 94) << share;
        EXPECT_LE(coverage, 97.5) << share;
    }
}

// The band is meant for the worst place: of small samples it holds somewhat more often than it says.
TEST(Intervals, TheBandHoldsTheWholeDistributionFunction) {
    RandomStream random(1, "band");
    constexpr std::size_t samples = 2000, n = 150;
    std::size_t held = 0;
    std::vector<double> values(n);
    for (std::size_t i = 0; i < samples; ++i) {
        double largest = 0;
        for (double& value : values)
            value = random.uniform();
        std::sort(values.begin(), values.end());
        for (std::size_t k = 0; k < n; ++k)
            largest =
                std::max({largest, static_cast<double>(k + 1) / n - values[k], values[k] - static_cast<double>(k) / n});
        held += largest <= distribution_band(n) ? 1U : 0U;
    }
    const double coverage = 100.0 * static_cast<double>(held) / samples;
    EXPECT_GE(coverage, 94);
    EXPECT_LE(coverage, 97.5);
    EXPECT_EQ(distribution_band(0), 1);
    EXPECT_EQ(distribution_band(1), 1);
}

}  // namespace
}  // namespace skyloop
