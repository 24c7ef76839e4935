#include "base/core/random.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <vector>

namespace skyloop {
namespace {

// Computed apart from the program, from the published descriptions of FNV-1a, SplitMix64 and xoshiro256++; the same
// computation gives xoshiro256++'s reference values 41943041, 58720359, 3588806011781223 from the state 1, 2, 3, 4.
TEST(RandomStream, FirstValuesAreKnown) {
    RandomStream position(1, "baseline.position");
    for (const std::uint64_t expected :
         {0x8d39f805f9782c15u, 0xc95e8aec5a04230fu, 0x9b0b198abfd9cec6u, 0x67264381ed929c43u})
        EXPECT_EQ(position.bits(), expected);
    RandomStream nameless(0, "");
    for (const std::uint64_t expected :
         {0x96bb3c9cab98ed3fu, 0x65b64fbc9a770e81u, 0xed86fb2d91de1ae1u, 0xc597f5e135156f81u})
        EXPECT_EQ(nameless.bits(), expected);
    RandomStream beyond_ascii(~std::uint64_t{0}, "\xc3\xa9");
    EXPECT_EQ(beyond_ascii.bits(), 0x370393b72d1470b1u);
}

TEST(RandomStream, FirstNormalValuesAreKnown) {
    RandomStream clock(42, "clock");
    for (const double expected : {-1.4967042924653862, -0.33130510461613627, 0.32321026675189646, -1.2105100625648197})
        EXPECT_DOUBLE_EQ(clock.normal(), expected);
}

TEST(RandomStream, UniformIsUniform) {
    RandomStream stream(7, "uniform");
    constexpr int count = 200'000;
    constexpr std::size_t bins = 20;
    std::array<int, bins> filled{};
    for (int i = 0; i < count; ++i) {
        const double value = stream.uniform();
        ASSERT_GE(value, 0.0);
        ASSERT_LT(value, 1.0);
        ++filled[static_cast<std::size_t>(value * bins)];
    }
    double chi_squared = 0;
    const double expected = static_cast<double>(count) / bins;
    for (const int n : filled)
        chi_squared += (n - expected) * (n - expected) / expected;
    EXPECT_LT(chi_squared, 43.8);  // 19 degrees of freedom, 0.1 %
}

TEST(RandomStream, NormalHasTheMomentsOfTheStandardNormal) {
    RandomStream stream(7, "normal");
    constexpr int count = 400'000;
    std::array<double, 5> moments{};
    int beyond_three = 0;
    for (int i = 0; i < count; ++i) {
        const double value = stream.normal();
        for (std::size_t k = 1; k < moments.size(); ++k)
            moments[k] += std::pow(value, static_cast<double>(k)) / count;
        beyond_three += std::abs(value) > 3;
    }
    // Four standard errors each: sqrt(1, 2, 15, 96) / sqrt(count).
    const double error = 4 / std::sqrt(static_cast<double>(count));
    EXPECT_NEAR(moments[1], 0, error);
    EXPECT_NEAR(moments[2], 1, error * std::sqrt(2.0));
    EXPECT_NEAR(moments[3], 0, error * std::sqrt(15.0));
    EXPECT_NEAR(moments[4], 3, error * std::sqrt(96.0));
    EXPECT_NEAR(beyond_three / static_cast<double>(count), 0.0026998, 4 * std::sqrt(0.0027 / count));
}

TEST(RandomStream, OneSeedAndNameRepeatThemselves) {
    RandomStream once(3, "a");
    RandomStream again(3, "a");
    for (int i = 0; i < 1000; ++i)
        ASSERT_EQ(once.bits(), again.bits());
}

TEST(RandomStream, NamesAndSeedsGiveIndependentStreams) {
    std::set<std::uint64_t> first_values;
    constexpr std::array<const char*, 6> names{"", "a", "b", "ab", "ba", "baseline.position"};
    for (const char* name : names)
        for (const std::uint64_t seed : {0u, 1u, 2u, 1000u})
            first_values.insert(RandomStream(seed, name).bits());
    EXPECT_EQ(first_values.size(), names.size() * 4);

    RandomStream a(5, "receiver.clock");
    RandomStream b(5, "receiver.cloak");
    double correlation = 0;
    constexpr int count = 100'000;
    for (int i = 0; i < count; ++i)
        correlation += a.normal() * b.normal() / count;
    EXPECT_NEAR(correlation, 0, 4 / std::sqrt(static_cast<double>(count)));
}

TEST(RandomStream, DrawingFromOneDoesNotMoveAnother) {
    RandomStream alone(9, "x");
    std::vector<double> expected;
    for (int i = 0; i < 100; ++i)
        expected.push_back(alone.normal());

    RandomStream with_company(9, "x");
    RandomStream company(9, "y");
    for (int i = 0; i < 100; ++i) {
        company.normal();
        EXPECT_EQ(with_company.normal(), expected[static_cast<std::size_t>(i)]);
    }
}

TEST(IndexedNormals, AreStandardNormalAndKnownByTheirIndex) {
    const IndexedNormals numbers(RandomStream(4, "x")), same(RandomStream(4, "x")), other(RandomStream(5, "x"));
    double sum = 0, square = 0, fourth = 0, lagged = 0;
    constexpr int count = 100'000;
    for (int i = 0; i < count; ++i) {
        const double value = numbers.at(i - count / 2);
        sum += value;
        square += value * value;
        fourth += value * value * value * value;
        lagged += value * numbers.at(i - count / 2 + 1);
    }
    EXPECT_NEAR(sum / count, 0, 0.015);
    EXPECT_NEAR(square / count, 1, 0.02);
    EXPECT_NEAR(fourth / count, 3, 0.12);
    EXPECT_NEAR(lagged / count, 0, 0.015);
    EXPECT_EQ(numbers.at(17), same.at(17));
    EXPECT_NE(numbers.at(17), other.at(17));
}

}  // namespace
}  // namespace skyloop
