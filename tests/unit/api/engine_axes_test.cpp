// The axes of engines, as the example plugin turns them: north-east, climbing, banked to the right.
#include "examples/engine/gnss_sensor.hpp"

#include <gtest/gtest.h>

#include "base/geo/attitude.hpp"

namespace {

using engine_example::Pose;
using engine_example::UnrealNorth;
using skyloop::Angle;

constexpr double pi = 3.14159265358979323846;

// Yaw 45°, pitch 10° up, roll 20° right wing down.
const Eigen::Quaterniond banked_climb =
    skyloop::Attitude::roll_pitch_yaw(Angle::degrees(20), Angle::degrees(10), Angle::degrees(45)).body_to_ned();

Eigen::Quaterniond about(double degrees, const Eigen::Vector3d& axis) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(degrees * pi / 180, axis));
}

std::array<double, 4> wxyz(const Eigen::Quaterniond& q) { return {q.w(), q.x(), q.y(), q.z()}; }

void expect_pose(const Pose& pose) {
    EXPECT_NEAR(pose.ned_m[0], 3, 1e-12);
    EXPECT_NEAR(pose.ned_m[1], 4, 1e-12);
    EXPECT_NEAR(pose.ned_m[2], -5, 1e-12);
    EXPECT_NEAR(pose.velocity_ned_mps[0], 1, 1e-12);
    EXPECT_NEAR(pose.velocity_ned_mps[1], 2, 1e-12);
    EXPECT_NEAR(pose.velocity_ned_mps[2], -0.5, 1e-12);
    const Eigen::Quaterniond told(pose.q_nb[0], pose.q_nb[1], pose.q_nb[2], pose.q_nb[3]);
    EXPECT_NEAR(told.angularDistance(banked_climb), 0, 1e-7);
}

TEST(EngineAxes, OfGazebo) {
    // East, north, up: the yaw counts from east, counter-clockwise; nose up is a negative turn about left.
    const auto q = about(45, {0, 0, 1}) * about(-10, {0, 1, 0}) * about(20, {1, 0, 0});
    expect_pose(engine_example::pose_of_gazebo({4, 3, 5}, {2, 1, 0.5}, wxyz(q)));
}

// Left-handed turns: yaw from X to Y, pitch up and roll to the right are what Unreal calls positive. As quaternion its
// FRotator(pitch, yaw, roll) is that of the turns with the signs of roll and pitch changed.
Eigen::Quaterniond unreal_rotator(double pitch, double yaw, double roll) {
    return about(yaw, {0, 0, 1}) * about(-pitch, {0, 1, 0}) * about(-roll, {1, 0, 0});
}

TEST(EngineAxes, OfUnrealWithXToTheNorth) {
    expect_pose(engine_example::pose_of_unreal(UnrealNorth::along_x, {300, 400, 500}, {100, 200, 50},
                                               wxyz(unreal_rotator(10, 45, 20))));
}

TEST(EngineAxes, OfUnrealWithXToTheEast) {
    // Y points south: north-east lies 45° to the left of X.
    expect_pose(engine_example::pose_of_unreal(UnrealNorth::against_y, {400, -300, 500}, {200, -100, 50},
                                               wxyz(unreal_rotator(10, -45, 20))));
}

}  // namespace
