#include "base/core/units.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

namespace skyloop {
namespace {

TEST(Quantity, CalculatesWithItsOwnKind) {
    constexpr Metres a(7.5);
    constexpr Metres b(2.5);
    static_assert((a + b).value() == 10.0);
    static_assert((a - b).value() == 5.0);
    static_assert((-a).value() == -7.5);
    static_assert((a * 2.0).value() == 15.0 && (2.0 * a).value() == 15.0 && (a / 2.0).value() == 3.75);
    Metres sum;
    EXPECT_EQ(sum.value(), 0.0);
    sum += a;
    sum -= b;
    EXPECT_EQ(sum, Metres(5.0));
}

TEST(Quantity, Compares) {
    EXPECT_LT(Seconds(1), Seconds(2));
    EXPECT_GE(Seconds(2), Seconds(2));
    EXPECT_NE(Seconds(1), Seconds(2));
    const Seconds nothing(std::numeric_limits<double>::quiet_NaN());
    EXPECT_FALSE(nothing < Seconds(1));
    EXPECT_FALSE(nothing > Seconds(1));
}

TEST(Angle, SaysItsUnit) {
    EXPECT_DOUBLE_EQ(Angle::degrees(180).rad(), std::numbers::pi);
    EXPECT_DOUBLE_EQ(Angle::radians(std::numbers::pi / 6).deg(), 30.0);
    EXPECT_DOUBLE_EQ((Angle::degrees(350) + Angle::degrees(20)).deg(), 370.0);
    EXPECT_DOUBLE_EQ((Angle::degrees(10) - Angle::degrees(20)).deg(), -10.0);
    EXPECT_DOUBLE_EQ((-Angle::degrees(10) * 3).deg(), -30.0);
    EXPECT_LT(Angle::degrees(57), Angle::radians(1));
}

// Latitudes go through degrees, and 90.00000000000001 would be no latitude.
TEST(Angle, ALatitudeStaysALatitudeThroughDegrees) {
    for (int i = 0; i <= 900'000; ++i)
        ASSERT_LE(Angle::degrees(i * 1e-4).deg(), 90.0);
    EXPECT_EQ(Angle::degrees(90).deg(), 90.0);
    EXPECT_EQ(Angle::radians(std::numbers::pi / 2).deg(), 90.0);
}

}  // namespace
}  // namespace skyloop
