#include "campaigns/campaign/campaign_design.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace skyloop {
namespace {

TEST(CampaignDesign, ALatinHypercubeHasOneSampleInEachStratum) {
    for (const std::uint64_t count : {1U, 2U, 7U, 100U, 1000U}) {
        const auto samples = latin_hypercube_samples(count, 3, "run.duration_s");
        std::set<std::uint64_t> strata;
        for (const double u : samples) {
            EXPECT_GT(u, 0);
            EXPECT_LT(u, 1);
            strata.insert(static_cast<std::uint64_t>(u * static_cast<double>(count)));
        }
        EXPECT_EQ(samples.size(), count);
        EXPECT_EQ(strata.size(), count);
    }
}

TEST(CampaignDesign, ALatinHypercubeIsShuffledByKeyAndSeed) {
    const auto one = latin_hypercube_samples(100, 1, "a");
    EXPECT_EQ(one, latin_hypercube_samples(100, 1, "a"));
    EXPECT_NE(one, latin_hypercube_samples(100, 2, "a"));
    EXPECT_NE(one, latin_hypercube_samples(100, 1, "b"));
    EXPECT_FALSE(std::is_sorted(one.begin(), one.end()));
    // Two keys are not correlated: of 100 random pairs |r| is below 0.35 in 99.96 % of the cases.
    const auto other = latin_hypercube_samples(100, 1, "b");
    double sum = 0;
    for (std::size_t i = 0; i < one.size(); ++i)
        sum += (one[i] - 0.5) * (other[i] - 0.5);
    EXPECT_LT(std::abs(sum / 100 * 12), 0.35);
}

TEST(CampaignDesign, RandomSamplesFillTheRange) {
    const auto samples = random_samples(10'000, 1, "x");
    double sum = 0, squares = 0;
    for (const double u : samples)
        sum += u, squares += u * u;
    EXPECT_NEAR(sum / 10'000, 0.5, 0.01);
    EXPECT_NEAR(squares / 10'000, 1.0 / 3, 0.01);
}

double number_of(const CampaignValue& value) { return std::stod(value.toml); }

TEST(CampaignDesign, QuantilesOfTheSpreads) {
    EXPECT_DOUBLE_EQ(number_of(value_at(UniformSpread{10, 20}, 0.25)), 12.5);
    EXPECT_NEAR(number_of(value_at(LogUniformSpread{1, 1e4}, 0.5)), 100, 1e-9);
    const NormalSpread normal{5, 2};
    EXPECT_NEAR(number_of(value_at(normal, 0.5)), 5, 1e-9);
    EXPECT_NEAR(number_of(value_at(normal, 0.975)), 5 + 2 * 1.959963984540, 1e-9);  // Abramowitz and Stegun 26.2
    EXPECT_NEAR(number_of(value_at(normal, 0.00135)), 5 - 2 * 2.999976992703, 1e-8);
    EXPECT_EQ(value_at(UniformSpread{0, 2}, 0.5).toml, "1.0") << "stays no whole number";
    EXPECT_EQ(value_at(WholeSpread{-1, 1}, 0.1).toml, "-1");
    EXPECT_EQ(value_at(WholeSpread{-1, 1}, 0.5).toml, "0");
    EXPECT_EQ(value_at(WholeSpread{-1, 1}, 0.999999999).toml, "1");
    const std::vector<CampaignValue> words{{"\"a\"", "a"}, {"\"b\"", "b"}};
    EXPECT_EQ(value_at(words, 0.49).shown, "a");
    EXPECT_EQ(value_at(words, 0.5).shown, "b");
}

TEST(CampaignDesign, SizesOfAGrid) {
    EXPECT_EQ(grid_size(WholeSpread{3, 7}), 5U);
    EXPECT_EQ(grid_value(WholeSpread{3, 7}, 4).toml, "7");
    EXPECT_EQ(grid_size(UniformSpread{}), 0U);
    EXPECT_EQ(grid_size(WholeSpread{-9007199254740992, 9007199254740992}), 18014398509481985U);
}

}  // namespace
}  // namespace skyloop
