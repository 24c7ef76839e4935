#include "base/geo/simulator_frames.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/core/random.hpp"

namespace skyloop {
namespace {

const Geodetic odesa = Geodetic::degrees(46.4774, 30.7326, 50);

// X forward, Y right, Z up, in centimetres: what the Unreal engine uses.
LevelPlacement engine_placement(double yaw_deg, bool left_handed) {
    LevelPlacement placement;
    placement.origin = odesa;
    placement.yaw = Angle::degrees(yaw_deg);
    placement.unit = Metres(0.01);
    placement.left_handed = left_handed;
    return placement;
}

Eigen::Vector3d enu_of(const LevelFrame& frame, const Position<Level>& point) {
    return LocalFrame(odesa).to_enu(frame.to_ecef(point)).vector();
}

// The course over ground of a velocity given in the level, degrees.
double course_deg(const LevelFrame& frame, const Velocity<Level>& velocity) {
    const Eigen::Vector3d enu = LocalFrame(odesa).to_enu(frame.to_ecef(velocity)).vector();
    return std::remainder(std::atan2(enu.x(), enu.y()) * 180 / std::numbers::pi, 360.0);
}

TEST(LevelFrame, LeftHandedCentimetres) {
    const LevelFrame north(engine_placement(0, true));
    EXPECT_LE((enu_of(north, {100'000, 0, 0}) - Eigen::Vector3d(0, 1000, 0)).norm(), 1e-6);  // forward is north
    EXPECT_LE((enu_of(north, {0, 100'000, 0}) - Eigen::Vector3d(1000, 0, 0)).norm(), 1e-6);  // right is east
    EXPECT_LE((enu_of(north, {0, 0, 250}) - Eigen::Vector3d(0, 0, 2.5)).norm(), 1e-6);       // up
    const LevelFrame east(engine_placement(90, true));
    EXPECT_LE((enu_of(east, {100'000, 0, 0}) - Eigen::Vector3d(1000, 0, 0)).norm(), 1e-6);   // forward is east
    EXPECT_LE((enu_of(east, {0, 100'000, 0}) - Eigen::Vector3d(0, -1000, 0)).norm(), 1e-6);  // right is south
}

TEST(LevelFrame, RightHandedMetresHaveYToTheLeft) {
    LevelPlacement placement;
    placement.origin = odesa;
    const LevelFrame frame(placement);
    EXPECT_LE((enu_of(frame, {1000, 0, 0}) - Eigen::Vector3d(0, 1000, 0)).norm(), 1e-6);
    EXPECT_LE((enu_of(frame, {0, 1000, 0}) - Eigen::Vector3d(-1000, 0, 0)).norm(), 1e-6);
    placement.yaw = Angle::degrees(90);  // then X is east and Y north: the level is ENU itself
    EXPECT_LE((enu_of(LevelFrame(placement), {30, 40, 5}) - Eigen::Vector3d(30, 40, 5)).norm(), 1e-6);
}

TEST(LevelFrame, TheWrongHandMirrorsHeadings) {
    for (const double yaw : {0.0, 30.0, 200.0})
        for (const double turn : {10.0, 80.0, 170.0, 300.0}) {
            const double radians = Angle::degrees(turn).rad();
            const Velocity<Level> velocity(500 * std::cos(radians), 500 * std::sin(radians), 0);
            // Turning right by `turn` from the X axis; with the wrong hand it is a turn left.
            EXPECT_NEAR(
                std::remainder(course_deg(LevelFrame(engine_placement(yaw, true)), velocity) - (yaw + turn), 360), 0,
                1e-9);
            EXPECT_NEAR(
                std::remainder(course_deg(LevelFrame(engine_placement(yaw, false)), velocity) - (yaw - turn), 360), 0,
                1e-9);
        }
}

TEST(LevelFrame, VelocitiesAreScaledToMetresPerSecond) {
    const LevelFrame frame(engine_placement(33, true));
    EXPECT_NEAR(frame.to_ecef(Velocity<Level>(300, -400, 0)).vector().norm(), 5.0, 1e-12);
}

TEST(LevelFrame, DistancesAreKept) {
    RandomStream random(1, "test.level_frame");
    for (int i = 0; i < 2'000; ++i) {
        const LevelFrame frame(engine_placement(360 * random.uniform(), random.bits() % 2 == 0));
        const auto point = [&] {
            return Position<Level>(random.normal() * 1e5, random.normal() * 1e5, random.normal() * 1e4);
        };
        const Position<Level> one = point(), other = point();
        ASSERT_NEAR((frame.to_ecef(other) - frame.to_ecef(one)).length().value(),
                    (other.vector() - one.vector()).norm() / 100, 1e-6);
    }
}

TEST(LevelFrame, IsFlatWhileTheEarthIsNot) {
    LevelPlacement placement = engine_placement(0, true);
    placement.origin = Geodetic::degrees(46.4774, 30.7326, 0);
    const LevelFrame frame(placement);
    const Geodetic edge = to_geodetic(frame.to_ecef(Position<Level>(400'000, 0, 0)));
    EXPECT_NEAR(edge.height.above_ellipsoid.value(), 1.256074, 1e-4);  // geodesy_tangent_plane_height.csv, pF09
}

TEST(LevelFrame, ReachEndsAtFourKilometres) {
    const LevelFrame frame(engine_placement(45, true));
    EXPECT_FALSE(frame.beyond_reach({399'999, 0, 0}));
    EXPECT_FALSE(frame.beyond_reach({400'000, 0, 0}));
    EXPECT_TRUE(frame.beyond_reach({400'001, 0, 0}));
    EXPECT_TRUE(frame.beyond_reach({300'000, -300'000, 0}));
    EXPECT_FALSE(frame.beyond_reach({0, 0, 10'000'000}));  // height does not count
    LevelPlacement shorter = engine_placement(45, true);
    shorter.reach = Metres(100);
    EXPECT_TRUE(LevelFrame(shorter).beyond_reach({0, 10'001, 0}));
}

}  // namespace
}  // namespace skyloop
