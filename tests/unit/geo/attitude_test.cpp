#include "base/geo/attitude.hpp"

#include <gtest/gtest.h>

namespace skyloop {
namespace {

Angle deg(double value) { return Angle::degrees(value); }

TEST(Attitude, GivesBackItsAngles) {
    for (const double roll : {-170.0, -30.0, 0.0, 45.0, 179.0})
        for (const double pitch : {-89.0, -10.0, 0.0, 60.0})
            for (const double yaw : {-179.0, -90.0, 0.0, 20.0, 135.0}) {
                const Attitude a = Attitude::roll_pitch_yaw(deg(roll), deg(pitch), deg(yaw));
                EXPECT_NEAR(a.roll().deg(), roll, 1e-6);
                EXPECT_NEAR(a.pitch().deg(), pitch, 1e-6);
                EXPECT_NEAR(a.yaw().deg(), yaw, 1e-6);
            }
}

// Looking east, nose up: forward points east and up, right points south.
TEST(Attitude, TurnsBodyAxesIntoNorthEastDown) {
    const Attitude a = Attitude::roll_pitch_yaw(deg(0), deg(30), deg(90));
    const Eigen::Vector3d forward = a.body_to_ned() * Eigen::Vector3d::UnitX();
    EXPECT_NEAR(forward.x(), 0, 1e-12);
    EXPECT_NEAR(forward.y(), std::cos(deg(30).rad()), 1e-12);
    EXPECT_NEAR(forward.z(), -0.5, 1e-12);
    const Eigen::Vector3d right = a.body_to_ned() * Eigen::Vector3d::UnitY();
    EXPECT_NEAR(right.x(), -1, 1e-12);
    // Rolled to the right the right side points down.
    const Attitude rolled = Attitude::roll_pitch_yaw(deg(90), deg(0), deg(0));
    EXPECT_NEAR((rolled.body_to_ned() * Eigen::Vector3d::UnitY()).z(), 1, 1e-12);
}

TEST(Attitude, TakesQuaternionsOfAnyLength) {
    const Attitude a(Eigen::Quaterniond(2, 0, 0, 0));
    EXPECT_NEAR(a.body_to_ned().norm(), 1, 1e-15);
    EXPECT_NEAR(a.yaw().deg(), 0, 1e-12);
}

}  // namespace
}  // namespace skyloop
