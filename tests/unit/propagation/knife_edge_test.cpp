#include "world/propagation/diffraction.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "world/gnss/constants.hpp"

namespace skyloop {
namespace {

TEST(KnifeEdge, LosesSixDecibelsAtTheEdge) {
    EXPECT_NEAR(knife_edge_loss(0).value(), 6.9 + 20 * std::log10(std::sqrt(1.01) - 0.1), 1e-12);
    EXPECT_NEAR(knife_edge_loss(0).value(), 6.03, 0.01);
}

TEST(KnifeEdge, FadesOutWhereTheEdgeIsClear) {
    EXPECT_EQ(knife_edge_loss(-0.78).value(), 0);
    EXPECT_EQ(knife_edge_loss(-5).value(), 0);
    EXPECT_LT(knife_edge_loss(-0.77).value(), 0.1);
    double before = 0;
    for (double v = -0.8; v < 20; v += 0.01) {
        const double loss = knife_edge_loss(v).value();
        EXPECT_GE(loss, before - 1e-12) << v;
        before = loss;
    }
}

// The asymptote of Fresnel's integral, 20 lg(π√2 v).
TEST(KnifeEdge, FollowsFresnelDeepInTheShadow) {
    for (const double v : {5.0, 10.0, 40.0})
        EXPECT_NEAR(knife_edge_loss(v).value(), 20 * std::log10(std::sqrt(2.0) * 3.14159265 * v), 0.2);
}

TEST(KnifeEdge, ParameterGrowsWithTheRootOfDistance) {
    const Hertz l1(carrier_frequency_l1);
    const double v = knife_edge_parameter(Angle::degrees(5), Metres(10), l1);
    EXPECT_NEAR(v, Angle::degrees(5).rad() * std::sqrt(20 / 0.190293673), 1e-6);
    EXPECT_NEAR(knife_edge_parameter(Angle::degrees(-5), Metres(40), l1), -2 * v, 1e-12);
}

TEST(KnifeEdge, ReachesAsFarAsTheWaveIsNotClear) {
    const Hertz l1(carrier_frequency_l1);
    for (const double degrees : {0.5, 8.0, 27.0}) {
        const Metres reach = knife_edge_reach(Angle::degrees(degrees), l1);
        EXPECT_NEAR(knife_edge_parameter(Angle::degrees(-degrees), reach, l1), knife_edge_clear, 1e-12);
    }
    EXPECT_NEAR(knife_edge_reach(Angle::degrees(8), l1).value(), 2.97, 0.01);
}

}  // namespace
}  // namespace skyloop
