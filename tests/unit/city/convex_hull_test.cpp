#include "world/city/footprint.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace skyloop {
namespace {

TEST(ConvexHull, IsOfTheOutermostPointsThatHaveAPlace) {
    constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();
    std::vector<Eigen::Vector2d> points;
    for (int i = 0; i < 100; ++i) {
        points.emplace_back(i % 10, i / 10);
        points.emplace_back(i % 3 == 0 ? nowhere : 5, i % 3 == 1 ? nowhere : 5);
        points.emplace_back(nowhere, std::numeric_limits<double>::infinity());
    }
    const std::vector<Eigen::Vector2d> hull = convex_hull(points);
    EXPECT_EQ(hull.size(), 4U);
    EXPECT_NEAR(hull_area(hull), 81, 1e-12);
}

TEST(ConvexHull, OfPointsInALineHasNoArea) {
    const std::vector<Eigen::Vector2d> hull = convex_hull({{0, 0}, {1, 1}, {2, 2}, {0, 0}});
    EXPECT_LT(hull.size(), 3U);
    EXPECT_EQ(hull_area(hull), 0);
}

}  // namespace
}  // namespace skyloop
