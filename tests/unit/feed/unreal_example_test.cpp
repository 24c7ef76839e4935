// The axes of the example for Unreal.
#include <gtest/gtest.h>

#include <cmath>

#include "../../../examples/unreal/SkyloopAxes.h"
#include "base/geo/attitude.hpp"

namespace skyloop {
namespace {

// Unreal's quaternion of a rotator (its FRotator::Quaternion), degrees: yaw from X towards Y, pitch up, roll right.
std::array<double, 4> unreal_quaternion(double pitch, double yaw, double roll) {
    const auto half = [](double degrees) { return Angle::degrees(degrees / 2).rad(); };
    const double sp = std::sin(half(pitch)), cp = std::cos(half(pitch)), sy = std::sin(half(yaw)),
                 cy = std::cos(half(yaw));
    const double sr = std::sin(half(roll)), cr = std::cos(half(roll));
    return {cr * sp * sy - sr * cp * cy, -cr * sp * cy - sr * cp * sy, cr * cp * sy - sr * sp * cy,
            cr * cp * cy + sr * sp * sy};
}

Attitude attitude_of_actor(double yaw, bool x_is_north) {
    const auto actor = unreal_quaternion(10, yaw, 20);
    const auto q = SkyloopAxes::ToBodyToNed(actor[0], actor[1], actor[2], actor[3], x_is_north);
    return Attitude(Eigen::Quaterniond(q[0], q[1], q[2], q[3]));
}

TEST(UnrealExample, BankedClimbHasTheSameAttitudeInBothConventions) {
    // X east: a yaw of −36.87° is a heading of 53.13°; X north: the yaw is the heading.
    for (const auto& [yaw, x_is_north] : {std::pair{-36.87, false}, std::pair{53.13, true}}) {
        const Attitude attitude = attitude_of_actor(yaw, x_is_north);
        EXPECT_NEAR(attitude.yaw().deg(), 53.13, 1e-9);
        EXPECT_NEAR(attitude.pitch().deg(), 10, 1e-9);
        EXPECT_NEAR(attitude.roll().deg(), 20, 1e-9);
    }
}

TEST(UnrealExample, CentimetresBecomeMetresNorthEastDown) {
    EXPECT_EQ(SkyloopAxes::ToNed(400, -300, 200, false), (SkyloopAxes::Vector{3, 4, -2}));
    EXPECT_EQ(SkyloopAxes::ToNed(300, 400, 200, true), (SkyloopAxes::Vector{3, 4, -2}));
}

}  // namespace
}  // namespace skyloop
