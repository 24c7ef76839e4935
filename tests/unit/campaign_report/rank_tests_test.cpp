// Rank tests against scipy, and how often they cry wolf.
#include "campaigns/campaign_report/statistical_tests.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/core/random.hpp"

namespace skyloop {
namespace {

const std::vector<double> rank_x{1, 2, 2, 3, 5, 8, 13, 21, 21, 34, 55, 89};
const std::vector<double> rank_y{3.1, 2.7, 4.4, 4.4, 1.0, 6.5, 5.9, 9.1, 7.7, 4.4, 9.9, 8.0};

TEST(RankTests, EqualValuesShareTheMeanOfTheirRanks) {
    EXPECT_THAT(average_ranks(rank_y), ::testing::ElementsAre(3, 2, 5, 5, 1, 8, 7, 11, 9, 5, 12, 10));
    EXPECT_TRUE(average_ranks({}).empty());
}

TEST(RankTests, SpearmanIsThatOfScipy) {
    // scipy 1.10.1: stats.spearmanr(rank_x, rank_y)
    const auto correlation = spearman_correlation(rank_x, rank_y);
    ASSERT_TRUE(correlation);
    EXPECT_NEAR(correlation->rho, 0.759722057489, 1e-12);
    EXPECT_NEAR(correlation->p_value, 0.00414477513468, 1e-12);
    EXPECT_EQ(correlation->n, 12u);
}

TEST(RankTests, SpearmanSeesOnlyTheOrder) {
    const std::vector<double> x{1, 2, 3, 4, 5}, falling{100, 99, -7, -8, -1e9};
    EXPECT_EQ(spearman_correlation(x, falling)->rho, -1);
    EXPECT_EQ(spearman_correlation(x, falling)->p_value, 0);
}

TEST(RankTests, SayNothingOfTooLittle) {
    const std::vector<double> two{1, 2}, three{1, 2, 3}, equal{4, 4, 4};
    EXPECT_FALSE(spearman_correlation(two, two));
    EXPECT_FALSE(spearman_correlation(three, two));
    EXPECT_FALSE(spearman_correlation(three, equal));
    const std::vector<std::size_t> one_group{1, 1, 1}, groups{0, 1, 1};
    EXPECT_FALSE(kruskal_wallis_test(three, one_group));
    EXPECT_FALSE(kruskal_wallis_test(equal, groups));
    EXPECT_FALSE(kruskal_wallis_test(two, std::span(groups).first(2)));
}

TEST(RankTests, KruskalWallisIsThatOfScipy) {
    // scipy 1.10.1: stats.kruskal of the three groups; ε² = H / (n − 1).
    const std::vector<double> values{6.4, 6.8, 7.2, 8.3, 8.4, 9.1, 9.4, 9.7, 2.5, 3.7, 4.9,
                                     5.4, 5.9, 8.1, 8.2, 1.3, 4.1, 4.9, 5.2, 5.5, 8.2};
    std::vector<std::size_t> group(8, 7);
    group.insert(group.end(), 7, 0);
    group.insert(group.end(), 6, 3);
    const auto test = kruskal_wallis_test(values, group);
    ASSERT_TRUE(test);
    EXPECT_NEAR(test->h, 9.849061861416, 1e-11);
    EXPECT_NEAR(test->p_value, 0.00726613380081, 1e-12);
    EXPECT_NEAR(test->strength, 0.492453093071, 1e-11);
    EXPECT_EQ(test->groups, 3u);
}

TEST(RankTests, OneInTwentyOfUnrelatedSeriesIsBelowFivePercent) {
    RandomStream random(1, "rank tests");
    constexpr int samples = 3000, n = 60;
    int trends = 0, differences = 0;
    for (int i = 0; i < samples; ++i) {
        std::vector<double> x, y;
        std::vector<std::size_t> group;
        for (std::size_t k = 0; k < n; ++k) {
            x.push_back(random.uniform());
            y.push_back(random.normal());
            group.push_back(k % 5);
        }
        trends += spearman_correlation(x, y)->p_value < 0.05 ? 1 : 0;
        differences += kruskal_wallis_test(y, group)->p_value < 0.05 ? 1 : 0;
    }
    EXPECT_NEAR(100.0 * trends / samples, 5, 1.5);
    EXPECT_NEAR(100.0 * differences / samples, 5, 1.5);
}

}  // namespace
}  // namespace skyloop
