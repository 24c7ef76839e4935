// Shapes on the Earth: places are met, velocities are slopes, attitudes follow from the motion.
#include "motion/trajectory/shaped_path.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "base/geo/local_frame.hpp"
#include "motion/trajectory/generated_path.hpp"
#include "motion/trajectory/waypoint_plan.hpp"

namespace skyloop {
namespace {

const GpsTime shaped_start = to_gps_time(2304, 100000.0);

TruthState state_of(const Trajectory& path, double t) { return path.at(advanced(shaped_start, Seconds(t))); }

// Velocity against differences of positions, turn rate against differences of attitudes.
void expect_consistent_states(const Trajectory& path, double t, double tolerance = 5e-6) {
    constexpr double step = 1e-3;
    const TruthState before = state_of(path, t - step), now = state_of(path, t), after = state_of(path, t + step);
    const Eigen::Vector3d slope = (after.position - before.position).vector() / (2 * step);
    EXPECT_LT((slope - now.velocity.vector()).norm(), tolerance) << t;
    EXPECT_LT((to_ecef(now.geodetic) - now.position).vector().norm(), 1e-6);
    ASSERT_TRUE(now.orientation);
    const Eigen::Quaterniond turned =
        before.orientation->attitude.body_to_ned().conjugate() * after.orientation->attitude.body_to_ned();
    const Eigen::AngleAxisd rotation(turned);
    EXPECT_LT((rotation.angle() / (2 * step) * rotation.axis() - now.orientation->turn_rate).norm(), 2e-2) << t;
}

TEST(GeodesicPlane, MeetsThePlacesItIsGiven) {
    const GeodesicPlane plane(Geodetic::degrees(47, 8, 500));
    for (const Geodetic& place : {Geodetic::degrees(47, 8, 500), Geodetic::degrees(47.0001, 8.0001, 520),
                                  Geodetic::degrees(50, 14, -20), Geodetic::degrees(43, 3, 11000)}) {
        LocalMotion motion;
        motion.position = plane.to_local(place);
        const GeodesicPlane::Placed placed = plane.place(shaped_start, motion);
        EXPECT_LT((placed.state.position - to_ecef(place)).vector().norm(), 1e-6);
    }
}

TEST(GeodesicPlane, CrossesTheDateLineAndThePole) {
    for (const auto& [a, b] : {std::pair{Geodetic::degrees(10, 179.99, 0), Geodetic::degrees(10, -179.99, 0)},
                               std::pair{Geodetic::degrees(89.99, 0, 0), Geodetic::degrees(89.99, 180, 0)}}) {
        const GeodesicPlane plane(a);
        WaypointWish wish;
        wish.vehicle = usual_limits(VehicleClass::plane);
        wish.waypoints = {{plane.to_local(a), 20, 0}, {plane.to_local(b), 20, 0}};
        const auto plan = plan_waypoints(wish);
        ASSERT_TRUE(plan);
        const ShapedPath path(shaped_start, plane, plan->shape, VehicleClass::plane);
        const double end = plan->shape->duration();
        EXPECT_LT((state_of(path, end).position - to_ecef(b)).vector().norm(), 1e-6);
        for (const double part : {0.2, 0.4, 0.7})
            expect_consistent_states(path, part * end);
    }
}

TEST(ShapedPath, FarFromItsOriginVelocitiesAreStillSlopes) {
    const GeodesicPlane plane(Geodetic::degrees(47, 8, 500));
    OrbitWish wish;
    wish.lap.vehicle = usual_limits(VehicleClass::plane);
    wish.lap.vehicle.along.speed = 250;
    wish.lap.centre = {300000, -200000, 11000};
    wish.radius = 9000;
    const auto plan = plan_orbit(wish);
    ASSERT_TRUE(plan) << plan.error();
    const ShapedPath path(shaped_start, plane, plan->shape, VehicleClass::plane);
    for (double t = 200; t < 600; t += 37)
        expect_consistent_states(path, t);
}

TEST(ShapedPath, APlaneBanksInItsTurn) {
    const GeodesicPlane plane(Geodetic::degrees(-33, 151, 100));
    OrbitWish wish;
    wish.lap.vehicle = usual_limits(VehicleClass::plane);
    wish.lap.centre.z() = 300;
    wish.radius = 60;
    const auto plan = plan_orbit(wish);
    ASSERT_TRUE(plan);
    const ShapedPath path(shaped_start, plane, plan->shape, VehicleClass::plane);
    const TruthState state = state_of(path, 100);
    // Coordinated: tan φ = v² / (g R); clockwise is to the right.
    const double bank = std::atan(20.0 * 20 / (9.80665 * 60));
    EXPECT_NEAR(state.orientation->attitude.roll().rad(), bank, 0.01);
    EXPECT_NEAR(state.orientation->attitude.pitch().deg(), 3, 0.2);
    const Eigen::Vector3d v = LocalFrame(state.geodetic).to_enu(state.velocity).vector();
    EXPECT_NEAR(std::remainder(state.orientation->attitude.yaw().rad() - std::atan2(v.x(), v.y()), 6.283185307), 0,
                1e-6);
    // The turn about the vertical, seen from the banked body.
    const double rate = 20.0 / 60;
    EXPECT_NEAR(state.orientation->turn_rate.norm(), rate, 2e-3);
    EXPECT_NEAR(state.orientation->turn_rate.z(), rate * std::cos(bank), 5e-3);
    expect_consistent_states(path, 100);
}

TEST(ShapedPath, AMultirotorLeansIntoItsAcceleration) {
    const GeodesicPlane plane(Geodetic::degrees(47, 8, 500));
    WaypointWish wish;
    wish.vehicle = usual_limits(VehicleClass::multirotor);
    wish.waypoints = {{{0, 0, 50}, 12, 0}, {{0, 500, 50}, 12, 0}};
    const auto plan = plan_waypoints(wish);
    ASSERT_TRUE(plan);
    const ShapedPath path(shaped_start, plane, plan->shape, VehicleClass::multirotor);
    EXPECT_NEAR(state_of(path, -10).orientation->attitude.pitch().deg(), 0, 1e-9);
    // At full acceleration of 4 m/s², and a drag of a tenth of the speed.
    const TruthState speeding = state_of(path, 1.5);
    const double v = speeding.velocity.vector().norm();
    EXPECT_NEAR(speeding.orientation->attitude.pitch().rad(), -std::atan((4 + 0.1 * v) / 9.80665), 0.02);
    for (double t = 0.05; t < plan->shape->duration(); t += 0.31)
        expect_consistent_states(path, t);
}

// What an antenna on an arm feels: it stands at the beginning and at the end, and its acceleration has no steps.
TEST(ShapedPath, NothingKnocksAnAntennaOnAnArm) {
    const GeodesicPlane plane(Geodetic::degrees(47, 8, 500));
    FigureEightWish eight;
    eight.lap.vehicle = usual_limits(VehicleClass::multirotor);
    eight.lap.centre.z() = 50;
    eight.lap.laps = 1;
    eight.half_length = 40;
    WaypointWish way;
    way.vehicle = eight.lap.vehicle;
    way.waypoints = {{{0, 0, 50}, 12, 0}, {{60, 80, 55}, 12, 0}};
    for (const auto& plan : {plan_figure_eight(eight), plan_waypoints(way)}) {
        ASSERT_TRUE(plan) << plan.error();
        const double end = plan->shape->duration();
        const ShapedPath path(shaped_start, plane, plan->shape, VehicleClass::multirotor);
        const Eigen::Vector3d arm(2, 1, -0.5);
        const auto speed_of_arm = [&](double t) -> Eigen::Vector3d {
            const Orientation turned = *state_of(path, t).orientation;
            return turned.attitude.body_to_ned() * turned.turn_rate.cross(arm);
        };
        for (const double t : {-1.0, -0.1, 0.0, end, end + 0.1, end + 1}) {
            EXPECT_LT(speed_of_arm(t).norm(), 2e-3) << t;
            EXPECT_NEAR(state_of(path, t).orientation->attitude.pitch().deg(), 0, 0.01) << t;
        }
        constexpr double step_s = 0.005, hardest_mps2 = 25, largest_change_mps2 = 1;
        std::optional<Eigen::Vector3d> before;
        for (double t = -1; t < std::min(end + 1, 40.0); t += step_s) {
            const Eigen::Vector3d acceleration = (speed_of_arm(t + step_s / 2) - speed_of_arm(t - step_s / 2)) / step_s;
            EXPECT_LT(acceleration.norm(), hardest_mps2) << t;
            if (before) {
                EXPECT_LT((acceleration - *before).norm(), largest_change_mps2) << t;
            }
            before = acceleration;
        }
    }
}

TEST(ShapedPath, ARocketStandsOnItsTail) {
    const GeodesicPlane plane(Geodetic::degrees(28, -80, 3));
    RocketWish wish;
    const auto plan = plan_rocket(wish);
    ASSERT_TRUE(plan) << plan.error();
    const ShapedPath path(shaped_start, plane, plan->shape, VehicleClass::rocket);
    const TruthState state = state_of(path, 2);
    const Eigen::Vector3d nose = state.orientation->attitude.body_to_ned() * Eigen::Vector3d::UnitX();
    EXPECT_NEAR(nose.z(), -1, 1e-9);
    expect_consistent_states(path, 2);
}

double nose_up_of(const Trajectory& path, double t) {
    return -(state_of(path, t).orientation->attitude.body_to_ned() * Eigen::Vector3d::UnitX()).z();
}

TEST(ShapedPath, AStepStandsAsItsOwnVehicle) {
    const GeodesicPlane plane(Geodetic::degrees(28, -80, 3));
    GeneratedPath sequence;
    sequence.steps.push_back({RocketWish{}, LocalShape::endless, usual_limits(VehicleClass::rocket)});
    const auto alone = plan_generated(sequence, 1);
    ASSERT_TRUE(alone) << alone.error();
    EXPECT_NEAR(nose_up_of(ShapedPath(shaped_start, plane, alone->shape, sequence.vehicle.kind), 2), 1, 1e-9);
    HoverWish hover;
    hover.place = {30, 0, 20};
    sequence.steps.push_back({hover, 20});
    const auto plan = plan_generated(sequence, 1);
    ASSERT_TRUE(plan) << plan.error();
    const ShapedPath path(shaped_start, plane, plan->shape, sequence.vehicle.kind);
    const double end = plan->shape->duration(), landed = alone->shape->duration();
    EXPECT_NEAR(nose_up_of(path, landed), 1, 1e-9) << "the rocket stands on its tail";
    EXPECT_LT(std::abs(nose_up_of(path, end - 10)), 0.5) << "the multirotor does not";
    constexpr double step_s = 0.02, fastest = 3;  // rad/s
    Eigen::Quaterniond before = state_of(path, landed - 1).orientation->attitude.body_to_ned();
    for (double t = landed - 1 + step_s; t < end; t += step_s) {
        const Eigen::Quaterniond now = state_of(path, t).orientation->attitude.body_to_ned();
        ASSERT_LT(before.angularDistance(now), fastest * step_s) << t;
        before = now;
    }
}

// It goes uphill, ahead at first and backwards in the end.
TEST(ShapedPath, ARoverThatTurnsOnItsWayUpTipsOverSmoothly) {
    const GeodesicPlane plane(Geodetic::degrees(48, 11, 0));
    GeneratedPath sequence;
    sequence.vehicle = usual_limits(VehicleClass::rover);
    HoverWish hover;
    hover.sway = 0;
    hover.place.z() = 300;
    sequence.steps.push_back({hover, 5});
    hover.place = {74, 33, 315};
    hover.heading = 3.5;
    sequence.steps.push_back({hover, 5});
    const auto plan = plan_generated(sequence, 1);
    ASSERT_TRUE(plan) << plan.error();
    const ShapedPath path(shaped_start, plane, plan->shape, sequence.vehicle.kind);
    constexpr double step_s = 0.01, fastest = 3;  // rad/s
    double highest = 0, lowest = 0, before = nose_up_of(path, 5);
    for (double t = 5; t < plan->shape->duration(); t += step_s) {
        const double now = nose_up_of(path, t);
        ASSERT_LT(std::abs(now - before), fastest * step_s) << t;
        highest = std::max(highest, now);
        lowest = std::min(lowest, now);
        before = now;
    }
    EXPECT_GT(highest, 0.1);
    EXPECT_LT(lowest, -0.1);
}

TEST(ShapedPath, AnotherVehicleAtTheSamePlaceTakesItsTime) {
    GeneratedPath sequence;
    sequence.steps.push_back({RocketWish{}, LocalShape::endless, usual_limits(VehicleClass::rocket)});
    sequence.steps.push_back({HoverWish{}, 10});
    const auto plan = plan_generated(sequence, 1);
    ASSERT_TRUE(plan) << plan.error();
    const auto rocket = plan_rocket({});
    ASSERT_TRUE(rocket) << rocket.error();
    const auto standing = plan->shape->standing(rocket->shape->duration() + 1);
    ASSERT_TRUE(standing);
    EXPECT_EQ(standing->from, VehicleClass::rocket);
    EXPECT_EQ(standing->to, VehicleClass::multirotor);
    EXPECT_NEAR(standing->part, 0.5, 1e-9) << "half of two seconds";
}

}  // namespace
}  // namespace skyloop
