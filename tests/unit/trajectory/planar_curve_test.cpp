// Curves by their length: headings are their directions, curvatures the change of those.
#include "motion/trajectory/planar_curve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace skyloop {
namespace {

constexpr double half_circle = std::numbers::pi;

void expect_curve_laws(const PlanarCurve& curve, double length) {
    constexpr double step = 1e-3;
    for (int i = 1; i < 500; ++i) {
        const double way = length * i / 500;
        const CurvePoint before = curve.at(way - step), now = curve.at(way), after = curve.at(way + step);
        const Eigen::Vector2d slope = (after.position - before.position) / (2 * step);
        EXPECT_NEAR(slope.x(), std::sin(now.heading), 1e-6) << way;
        EXPECT_NEAR(slope.y(), std::cos(now.heading), 1e-6) << way;
        const double turned = std::remainder(after.heading - before.heading, 2 * half_circle) / (2 * step);
        EXPECT_NEAR(turned, now.curvature, 1e-5) << way;
        EXPECT_NEAR(after.curvature, before.curvature, 1e-3) << way;
    }
}

TEST(ClothoidCurve, TurnsByTheAngleAskedFor) {
    for (const double degrees : {-150.0, -90.0, -3.0, 20.0, 60.0, 120.0, 170.0})
        for (const double ramp : {2.0, 15.0, 60.0}) {
            const TurnShape turn{degrees * half_circle / 180, 40, ramp};
            ClothoidCurve curve({});
            curve.run(50, 0);
            add_turn(curve, turn);
            curve.run(50, 0);
            EXPECT_NEAR(curve.end().heading, turn.angle, 1e-12);
            EXPECT_NEAR(curve.length(), 100 + turn_length(turn), 1e-9);
            // The turn leaves the one straight as far before the corner as it joins the other after it.
            const double reach = tangent_length(turn);
            const Eigen::Vector2d corner(0, 50 + reach);
            const Eigen::Vector2d out(std::sin(turn.angle), std::cos(turn.angle));
            EXPECT_LT((corner + (reach + 50) * out - curve.end().position).norm(), 1e-9) << degrees << " " << ramp;
            expect_curve_laws(curve, curve.length());
        }
}

// FEEDS.md 2.2: d = (R + Lr² / 24 R) tan(θ / 2) + Lr / 2 within 0.1 %, for short ramps.
TEST(ClothoidCurve, HasTheTangentLengthOfTheTextbook) {
    for (const double degrees : {40.0, 90.0, 130.0}) {
        const TurnShape turn{degrees * half_circle / 180, 60, 20};
        const double textbook = (60 + 20.0 * 20 / (24 * 60)) * std::tan(turn.angle / 2) + 10;
        EXPECT_NEAR(tangent_length(turn), textbook, 1e-3 * textbook);
    }
}

TEST(CircleCurve, IsAsLongAsItsCircumference) {
    const CircleCurve right({{10, 20}, 50, 0.3, false}), left({{10, 20}, 50, 0.3, true});
    expect_curve_laws(right, 2.5 * right.length());
    expect_curve_laws(left, left.length());
    EXPECT_LT((right.at(3 * right.length()).position - right.at(0).position).norm(), 1e-9);
}

// FEEDS.md 2.3: length 5.2441 a, tightest radius a / 3, straight in its crossing.
TEST(LemniscateCurve, HasTheLengthAndTheCurvatureOfTheTextbook) {
    const LemniscateCurve curve({{5, -3}, 90, 0.7});
    EXPECT_NEAR(curve.length(), 5.244115108584240 * 90, 1e-6);
    EXPECT_NEAR(curve.at(0).curvature, 0, 1e-12);
    EXPECT_NEAR(std::abs(curve.at(curve.length() / 4).curvature), 3.0 / 90, 1e-9);
    EXPECT_LT((curve.at(curve.length() / 4).position - Eigen::Vector2d(5, -3)).norm() - 90, 1e-9);
    EXPECT_LT((curve.at(curve.length() / 2).position - Eigen::Vector2d(5, -3)).norm(), 1e-9);
    expect_curve_laws(curve, 2 * curve.length());
}

}  // namespace
}  // namespace skyloop
