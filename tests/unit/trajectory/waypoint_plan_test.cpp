// Ways through waypoints: they keep the vehicle's limits, pass where they should, and say what does not fit.
#include "motion/trajectory/waypoint_plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "path_laws.hpp"

namespace skyloop {
namespace {

using testing::HasSubstr;

WaypointWish wish_of(VehicleClass kind, const std::vector<Eigen::Vector3d>& places) {
    WaypointWish wish;
    wish.vehicle = usual_limits(kind);
    for (const Eigen::Vector3d& place : places)
        wish.waypoints.push_back({place, wish.vehicle.along.speed, 0});
    return wish;
}

PathPlan planned(const WaypointWish& wish) {
    auto plan = plan_waypoints(wish);
    EXPECT_TRUE(plan) << plan.error();
    return plan ? *plan : PathPlan{};
}

std::string refused(const WaypointWish& wish) {
    const auto plan = plan_waypoints(wish);
    return plan ? "accepted" : plan.error();
}

// The least distance of a path from a place.
double passes_at(const LocalShape& shape, const Eigen::Vector3d& place) {
    double least = 1e9;
    for (double t = 0; t < shape.duration(); t += 0.02)
        least = std::min(least, (shape.at(t).position - place).norm());
    return least;
}

const std::vector<Eigen::Vector3d> big_square{{0, 0, 50},   {0, 400, 60},   {400, 400, 55},
                                              {400, 0, 50}, {700, 150, 50}, {1100, 160, 58}};

TEST(WaypointPlan, EveryVehicleKeepsItsLimits) {
    for (const VehicleClass kind : {VehicleClass::multirotor, VehicleClass::plane, VehicleClass::rover,
                                    VehicleClass::boat, VehicleClass::car, VehicleClass::pedestrian}) {
        SCOPED_TRACE(vehicle_name(kind));
        WaypointWish wish = wish_of(kind, big_square);
        if (kind == VehicleClass::boat)
            for (PlannedWaypoint& waypoint : wish.waypoints)
                waypoint.place.z() = 0;
        const VehicleLimits& v = wish.vehicle;
        const PathPlan plan = planned(wish);
        ASSERT_TRUE(plan.shape);
        const double turn_jerk = v.turn_ramp > 0 ? 1.7 * v.lateral / v.turn_ramp : 0;
        const auto most = test::expect_path_laws(*plan.shape, 1e6, std::max(v.along.jerk * 1.5, turn_jerk));
        EXPECT_LE(most.speed, v.along.speed * 1.02);
        EXPECT_GE(most.speed, v.along.speed * 0.95);
        EXPECT_LE(most.acceleration, std::hypot(v.lateral, v.along.acceleration) * 1.01);
        EXPECT_LE(most.climb, v.climb * 1.0001);
        EXPECT_LE(most.sink, v.sink * 1.0001);
        EXPECT_LT((plan.shape->at(0).position - wish.waypoints.front().place).norm(), 1e-9);
        EXPECT_LT((plan.shape->at(1e9).position - wish.waypoints.back().place).norm(), 1e-6);
    }
}

TEST(WaypointPlan, AMultirotorCutsCornersAndAPedestrianHardly) {
    EXPECT_LT(passes_at(*planned(wish_of(VehicleClass::pedestrian, big_square)).shape, big_square[1]), 0.5);
    const double cut = passes_at(*planned(wish_of(VehicleClass::multirotor, big_square)).shape, big_square[1]);
    EXPECT_LT(cut, 5);
    EXPECT_GT(cut, 0.5);
}

TEST(WaypointPlan, HoldsWhereItIsTold) {
    for (const VehicleClass kind : {VehicleClass::multirotor, VehicleClass::car}) {
        WaypointWish wish = wish_of(kind, big_square);
        wish.waypoints[2].hold = 30;
        const PathPlan plan = planned(wish);
        double stood = 0;
        for (double t = 5; t < plan.shape->duration() - 5; t += 0.05)
            if (plan.shape->at(t).velocity.norm() < 1e-9) stood += 0.05;
        EXPECT_NEAR(stood, 30, 0.2) << vehicle_name(kind);
        test::expect_path_laws(*plan.shape, 1e6, 20);
    }
}

TEST(WaypointPlan, AMultirotorRisesTurnsAndComesBack) {
    const PathPlan plan =
        planned(wish_of(VehicleClass::multirotor, {{0, 0, 0}, {0, 0, 30}, {100, 0, 30}, {0, 0.5, 30}, {0, 0.5, 0}}));
    const auto most = test::expect_path_laws(*plan.shape, 1e6, 12);
    EXPECT_LE(most.climb, 5.0001);
    EXPECT_LE(most.sink, 3.0001);
    EXPECT_LT(passes_at(*plan.shape, {0, 0, 30}), 0.05);
}

TEST(WaypointPlan, AMultirotorDoesNotTurnRoundAtOnceOnSteepLegs) {
    constexpr double fastest = std::numbers::pi / 2 * 1.001;  // 90° a second, standing
    // Nearly upright, with a faint corner half way up.
    const PathPlan upright =
        planned(wish_of(VehicleClass::multirotor, {{0, 0, 0}, {0, 0.011, 30}, {0.0075, 0, 60}, {60, 0, 60}}));
    EXPECT_LT(test::fastest_yaw(*upright.shape, 1e6), fastest);
    EXPECT_EQ(upright.shape->at(0).heading, 0);
    EXPECT_NEAR(upright.shape->at(1e6).heading, std::numbers::pi / 2, 1e-9);
    // 76° up to the north, and on to the south: 28° in space, 180° seen from above.
    const PathPlan back = planned(wish_of(VehicleClass::multirotor, {{0, 0, 0}, {0, 10, 40}, {0, 0, 80}}));
    EXPECT_LT(test::fastest_yaw(*back.shape, 1e6), fastest);
    EXPECT_LT(passes_at(*back.shape, {0, 10, 40}), 0.05) << "it stops where it turns round";
}

TEST(WaypointPlan, SlowsDownForATurnThatDoesNotFitAndTellsIt) {
    WaypointWish wish = wish_of(VehicleClass::car, {{0, 0, 0}, {0, 100, 0}, {16, 100, 0}, {16, 0, 0}});
    const PathPlan plan = planned(wish);
    ASSERT_EQ(plan.notes.size(), 2U);
    EXPECT_THAT(plan.notes[0], HasSubstr("waypoint 2, a turn of 90°: slowed to"));
    test::expect_path_laws(*plan.shape, 1e6, 20);
}

TEST(WaypointPlan, SaysWhatDoesNotFit) {
    EXPECT_THAT(refused(wish_of(VehicleClass::plane, {{0, 0, 50}, {0, 100, 50}, {30, 100, 50}, {30, 0, 50}})),
                HasSubstr("waypoint 2, a turn of 90°: a plane's turn there has a radius of"));
    EXPECT_THAT(refused(wish_of(VehicleClass::car, {{0, 0, 0}, {0, 100, 0}, {0, 0, 0}})),
                HasSubstr("waypoint 2, a turn of 180°"));
    EXPECT_THAT(refused(wish_of(VehicleClass::car, {{0, 0, 0}, {0, 0, 100}})), HasSubstr("straight up or down"));
    EXPECT_THAT(refused(wish_of(VehicleClass::plane, {{0, 0, 0}, {0, 300, 300}})), HasSubstr("up to 61.9° steep"));
    EXPECT_THAT(refused(wish_of(VehicleClass::car, {{5, 5, 5}, {5, 5, 5}})),
                HasSubstr("all waypoints lie at one place"));
    WaypointWish held = wish_of(VehicleClass::plane, big_square);
    held.waypoints[1].hold = 3;
    EXPECT_THAT(refused(held), HasSubstr("a plane cannot stop on its way"));
    WaypointWish slow = wish_of(VehicleClass::plane, big_square);
    slow.waypoints[1].speed = 3;
    EXPECT_THAT(refused(slow), HasSubstr("the speed is 3 m/s; expected at least 12"));
}

// Whatever the places, there is a path that keeps the laws or a sentence.
TEST(WaypointPlan, TakesRandomPlaces) {
    std::mt19937_64 engine(3);
    std::uniform_real_distribution<double> place(-300, 300), height(0, 40), hold(-20, 20);
    int accepted = 0;
    for (int round = 0; round < 60; ++round) {
        const auto kind = driven_vehicles.at(static_cast<std::size_t>(round % 6));
        std::vector<Eigen::Vector3d> places;
        for (int i = 0; i < 6; ++i)
            places.emplace_back(place(engine), place(engine), kind == VehicleClass::boat ? 0 : height(engine));
        WaypointWish wish = wish_of(kind, places);
        for (PlannedWaypoint& waypoint : wish.waypoints)
            if (kind != VehicleClass::plane) waypoint.hold = std::max(0.0, hold(engine));
        const auto plan = plan_waypoints(wish);
        if (!plan) continue;
        ++accepted;
        SCOPED_TRACE(vehicle_name(kind));
        const VehicleLimits& v = wish.vehicle;
        const auto most = test::expect_path_laws(*plan->shape, 1e6, 40);
        EXPECT_LE(most.acceleration, std::hypot(v.lateral, v.along.acceleration) * 1.01);
        EXPECT_LE(most.speed, v.along.speed * 1.07);
    }
    EXPECT_GE(accepted, 30);
}

// Of a circle that fits until it is left, the places go one after the other, from its end: were all looked at again
// each time, the turns of these 50,000 places would be reckoned 10⁹ times.
TEST(WaypointPlan, PassesByManyPlacesOneAfterTheOther) {
    std::vector<Eigen::Vector3d> places;
    for (int i = 0; i < 50'000; ++i)
        places.emplace_back(41 * std::sin(i * std::numbers::pi / 8), 41 * std::cos(i * std::numbers::pi / 8), 60);
    places.emplace_back(0, -9000, 60);
    WaypointWish wish = wish_of(VehicleClass::plane, places);
    wish.passes_by = true;
    const PathPlan plan = planned(wish);
    ASSERT_TRUE(plan.shape);
    EXPECT_THAT(plan.notes, testing::Contains(HasSubstr("places are passed by")));
    EXPECT_NEAR(passes_at(*plan.shape, places.back()), 0, 0.5);
}

}  // namespace
}  // namespace skyloop
