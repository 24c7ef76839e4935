#include "firmware/core/solution_covariance.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace skyloop::firmware {
namespace {

Fix fix_with(double east_dop, double north_dop) {
    Fix fix;
    fix.type = FixType::fix_3d;
    fix.dop.edop = east_dop;
    fix.dop.ndop = north_dop;
    fix.horizontal_accuracy = Metres(5);
    return fix;
}

SatelliteStatus at(double azimuth, double elevation) {
    return {{}, Angle::degrees(azimuth), Angle::degrees(elevation), std::nullopt, true};
}

TEST(ErrorEllipse, FollowsTheDopAlongTheAxesWithoutDirections) {
    const auto ellipse = error_ellipse(fix_with(3, 4), {});
    ASSERT_TRUE(ellipse);
    EXPECT_NEAR(ellipse->north.value(), 4, 1e-12);
    EXPECT_NEAR(ellipse->east.value(), 3, 1e-12);
    EXPECT_NEAR(ellipse->semi_major.value(), 4, 1e-12);
    EXPECT_NEAR(ellipse->semi_minor.value(), 3, 1e-12);
    EXPECT_NEAR(ellipse->orientation.deg(), 0, 1e-9);
    EXPECT_NEAR(error_ellipse(fix_with(4, 3), {})->orientation.deg(), 90, 1e-9);
}

// Satellites in the north-east and south-west say much along that line and little across it.
TEST(ErrorEllipse, TurnsAcrossTheLineOfTheSatellites) {
    const SatelliteStatus used[] = {at(45, 20), at(225, 20), at(40, 45), at(230, 45), at(0, 89), at(135, 70)};
    const auto ellipse = error_ellipse(fix_with(1, 1), used);
    ASSERT_TRUE(ellipse);
    EXPECT_NEAR(ellipse->orientation.deg(), 135, 1);
    EXPECT_GT(ellipse->semi_major.value(), 1.3 * ellipse->semi_minor.value());
    const double major = ellipse->semi_major.value(), minor = ellipse->semi_minor.value();
    EXPECT_NEAR(major * major + minor * minor, 25, 1e-9);
    EXPECT_NEAR(ellipse->north.value(), ellipse->east.value(), 1e-12);
}

TEST(ErrorEllipse, StandsSingularGeometryAndMissingDop) {
    const SatelliteStatus same[] = {at(10, 20), at(10, 20), at(10, 20), at(10, 20)};
    EXPECT_NEAR(error_ellipse(fix_with(3, 4), same)->semi_major.value(), 4, 1e-9);
    EXPECT_FALSE(error_ellipse(fix_with(0, 0), same));
    EXPECT_FALSE(error_ellipse(fix_with(std::nan(""), 1), same));
}

}  // namespace
}  // namespace skyloop::firmware
