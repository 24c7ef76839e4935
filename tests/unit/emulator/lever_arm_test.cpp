// Antennas beside the path of their vehicle.
#include "run/emulator/antenna_path.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/geo/local_frame.hpp"
#include "motion/trajectory/geometric_paths.hpp"

namespace skyloop {
namespace {

const GpsTime arm_start = to_gps_time(2400, 0);
const Geodetic arm_place = Geodetic::degrees(46, 30, 100);

// East, north, up from the vehicle to the antenna.
Eigen::Vector3d arm_enu(const Trajectory& antenna, const Trajectory& vehicle, GpsTime time) {
    const TruthState middle = vehicle.at(time);
    return LocalFrame(middle.geodetic).to_enu(antenna.at(time).position - middle.position).vector();
}

TEST(LeverArm, AtRestItLooksWhereItIsTold) {
    const FixedPoint vehicle(arm_place);
    const LeverArm antenna(std::make_unique<FixedPoint>(arm_place), {2, 1, -0.5}, Angle::degrees(90));
    const Eigen::Vector3d arm = arm_enu(antenna, vehicle, arm_start);
    EXPECT_NEAR(arm.x(), 2, 1e-6) << "ahead is east";
    EXPECT_NEAR(arm.y(), -1, 1e-6) << "right is south";
    EXPECT_NEAR(arm.z(), 0.5, 1e-6) << "negative down is up";
    EXPECT_EQ(antenna.at(arm_start).velocity.length().value(), 0);
    EXPECT_NEAR((to_ecef(antenna.at(arm_start).geodetic) - antenna.at(arm_start).position).length().value(), 0, 1e-6);
}

TEST(LeverArm, MovingItLooksWhereItGoes) {
    const Circle::Shape shape{arm_place, Metres(50), MetresPerSecond(5), Angle::degrees(0)};
    const Circle vehicle(arm_start, shape);
    const LeverArm antenna(std::make_unique<Circle>(arm_start, shape), {0, 3, 0}, Angle::degrees(123));
    for (const int second : {0, 7, 20, 55}) {
        const GpsTime time = arm_start + std::chrono::seconds(second);
        const double from_centre =
            LocalFrame(arm_place).to_enu(antenna.at(time).position - to_ecef(arm_place)).vector().head<2>().norm();
        EXPECT_NEAR(from_centre, 47, 1e-3) << "right of a clockwise path is its centre";
        EXPECT_NEAR(arm_enu(antenna, vehicle, time).norm(), 3, 1e-6);
    }
}

TEST(LeverArm, TheInsideOfATurnIsSlower) {
    const Circle::Shape shape{arm_place, Metres(50), MetresPerSecond(5), Angle::degrees(0)};
    const LeverArm antenna(std::make_unique<Circle>(arm_start, shape), {0, 10, 0}, Angle());
    const GpsTime time = arm_start + std::chrono::seconds(9);
    EXPECT_NEAR(antenna.at(time).velocity.length().value(), 4, 1e-3) << "40 of 50 m from the centre";
    const auto step = std::chrono::milliseconds(10);
    const Eigen::Vector3d passed = (antenna.at(time + step).position - antenna.at(time - step).position).vector();
    EXPECT_NEAR((passed / 0.02 - antenna.at(time).velocity.vector()).norm(), 0, 1e-3) << "the derivative of the place";
    EXPECT_NEAR(antenna.at(arm_start).velocity.length().value(), 4, 1e-2) << "from the first instant on";
}

TEST(LeverArm, AfterAStopItLooksWhereItWent) {
    const std::vector<Waypoint> corners{{arm_place, MetresPerSecond(10), Seconds(5)},
                                        {Geodetic::degrees(46, 30.001, 100), {}, {}}};
    const Waypoints vehicle(arm_start, corners);
    const LeverArm antenna(std::make_unique<Waypoints>(arm_start, corners), {1, 0, 0}, Angle::degrees(180));
    EXPECT_NEAR(arm_enu(antenna, vehicle, arm_start).y(), -1, 1e-6) << "south, as it was told";
    EXPECT_NEAR(arm_enu(antenna, vehicle, arm_start + std::chrono::seconds(8)).x(), 1, 1e-4) << "east, as it goes";
    EXPECT_NEAR(arm_enu(antenna, vehicle, arm_start + std::chrono::seconds(60)).x(), 1, 1e-4) << "and went";
}

TEST(LeverArm, ACornerIsNoSwing) {
    const std::vector<Waypoint> corners{{arm_place, MetresPerSecond(10), {}},
                                        {Geodetic::degrees(46, 30.001, 100), MetresPerSecond(10), {}},
                                        {Geodetic::degrees(46.001, 30.001, 100), {}, {}}};
    const LeverArm antenna(std::make_unique<Waypoints>(arm_start, corners), {1, 0, 0}, Angle());
    for (int ms = 0; ms < 12000; ++ms)
        ASSERT_LT(antenna.at(arm_start + std::chrono::milliseconds(ms)).velocity.length().value(), 15) << ms << " ms";
}

// Stands at a place and turns.
class Spinning : public Trajectory {
public:
    [[nodiscard]] TruthState at(GpsTime time) const override {
        const double t = difference(time, arm_start).value();
        TruthState state = FixedPoint(arm_place).at(time);
        state.orientation.emplace();
        state.orientation->attitude =
            Attitude::roll_pitch_yaw(Angle::degrees(10), Angle::degrees(-5), Angle::degrees(200 * t));
        // 200 °/s about the vertical, in the body's axes.
        state.orientation->turn_rate =
            state.orientation->attitude.body_to_ned().conjugate() * Eigen::Vector3d(0, 0, Angle::degrees(200).rad());
        return state;
    }
};

TEST(LeverArm, ATurnMovesTheAntennaInAllDirections) {
    // FEEDS.md 0: a 1 m arm at 200 °/s gives 3.5 m/s.
    const LeverArm level(std::make_unique<Spinning>(), {1, 0, 0}, Angle());
    EXPECT_NEAR(level.at(arm_start).velocity.length().value(), 3.49 * std::cos(Angle::degrees(5).rad()), 0.01);
    const LeverArm antenna(std::make_unique<Spinning>(), {0.8, -0.4, -1.5}, Angle());
    const auto step = std::chrono::microseconds(100);
    for (int ms = 0; ms < 2000; ms += 7) {
        const GpsTime time = arm_start + std::chrono::milliseconds(ms);
        const TruthState state = antenna.at(time);
        const Eigen::Vector3d passed = (antenna.at(time + step).position - antenna.at(time - step).position).vector();
        ASSERT_LT((passed / 2e-4 - state.velocity.vector()).norm(), 5e-5) << "the derivative of the place";
        ASSERT_NEAR((state.position - to_ecef(arm_place)).length().value(), std::sqrt(0.64 + 0.16 + 2.25), 1e-6);
        ASSERT_TRUE(state.orientation.has_value());
    }
}

TEST(LeverArm, ABankLowersTheRightWing) {
    const LeverArm antenna(std::make_unique<Spinning>(), {0, 2, 0}, Angle());
    const Eigen::Vector3d arm = arm_enu(antenna, FixedPoint(arm_place), arm_start);
    EXPECT_NEAR(arm.z(), -2 * std::sin(Angle::degrees(10).rad()) * std::cos(Angle::degrees(5).rad()), 1e-6);
}

}  // namespace
}  // namespace skyloop
