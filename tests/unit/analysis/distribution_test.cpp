#include "study/analysis/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/core/random.hpp"
#include "study/analysis/fix_series.hpp"

namespace skyloop {
namespace {

std::vector<double> normal_series(const std::string& name, std::size_t n, double mean) {
    RandomStream random(9, name);
    std::vector<double> values;
    for (std::size_t i = 0; i < n; ++i)
        values.push_back(mean + random.normal());
    return values;
}

TEST(DistributionDistance, is_zero_for_one_series_and_one_without_overlap) {
    const std::vector<double> a = normal_series("a", 500, 0);
    const auto same = distribution_distance(a, a);
    ASSERT_TRUE(same);
    EXPECT_DOUBLE_EQ(same->total_variation, 0);
    EXPECT_DOUBLE_EQ(same->kolmogorov_smirnov, 0);
    const auto apart = distribution_distance(a, normal_series("b", 700, 30));
    EXPECT_NEAR(apart->total_variation, 1, 1e-12);
    EXPECT_NEAR(apart->kolmogorov_smirnov, 1, 1e-12);
    EXPECT_FALSE(distribution_distance(a, {}));
}

TEST(DistributionDistance, of_shifted_normal_laws_is_the_known_one) {
    // Normal laws of unit variance one apart: both distances are 2·Phi(1/2) - 1 = 0.3829.
    const double expected = std::erf(0.5 / std::sqrt(2.0));
    const auto d = distribution_distance(normal_series("a", 200000, 0), normal_series("b", 100000, 1));
    EXPECT_NEAR(d->total_variation, expected, 0.01);
    EXPECT_NEAR(d->kolmogorov_smirnov, expected, 0.01);
    // Freedman-Diaconis: the interquartile range of the mixture, 1.53, of the smaller series' size.
    EXPECT_NEAR(d->bin_width, 2 * 1.53 / std::cbrt(100000.0), 0.01);
    const auto alike = distribution_distance(normal_series("a", 20000, 0), normal_series("c", 20000, 0));
    EXPECT_LT(alike->total_variation, 0.05);
    EXPECT_LT(alike->kolmogorov_smirnov, 0.02);
}

TEST(DistributionDistance, takes_ties_constants_and_wild_values) {
    const auto ties = distribution_distance(std::vector<double>{1, 1, 2, 2}, std::vector<double>{1, 2, 2, 2});
    EXPECT_DOUBLE_EQ(ties->kolmogorov_smirnov, 0.25);
    EXPECT_DOUBLE_EQ(ties->total_variation, 0.25);
    const auto constant = distribution_distance(std::vector<double>{3, 3}, std::vector<double>{3});
    EXPECT_EQ(constant->total_variation, 0);
    EXPECT_EQ(constant->bin_width, 0);
    std::vector<double> wild = normal_series("a", 1000, 0);
    wild[3] = 1e9;
    const auto d = distribution_distance(wild, normal_series("b", 1000, 0));
    EXPECT_LT(d->bin_width, 1);
    EXPECT_LE(d->bins, 500u);
    EXPECT_LT(d->total_variation, 0.2);
}

TEST(SignalStrength, is_summed_up_by_elevation_without_keeping_values) {
    SignalStrengthByElevation strengths;
    EXPECT_TRUE(strengths.empty());
    for (const double cn0 : {40.0, 42.0, 47.0})
        strengths.add({Angle::degrees(20), DbHz(cn0)});
    strengths.add({Angle::degrees(90), DbHz(50)});
    strengths.add({Angle::degrees(-5), DbHz(50)});
    strengths.add({Angle::degrees(25), DbHz(0)});
    EXPECT_EQ(strengths.bin(2).n(), 3u);
    EXPECT_DOUBLE_EQ(strengths.bin(2).mean(), 43);
    EXPECT_DOUBLE_EQ(strengths.bin(2).std(), std::sqrt(13.0));
    EXPECT_EQ(strengths.bin(8).n(), 1u);
    EXPECT_EQ(strengths.bin(8).std(), 0);
    EXPECT_EQ(strengths.bin(0).n() + strengths.bin(1).n(), 0u);
    EXPECT_FALSE(strengths.empty());
}

}  // namespace
}  // namespace skyloop
