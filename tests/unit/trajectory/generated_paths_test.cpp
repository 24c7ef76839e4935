// Generated paths of every kind keep the laws of paths, their own formulas and their seeds.
#include "motion/trajectory/generated_path.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "path_laws.hpp"

namespace skyloop {
namespace {

using testing::HasSubstr;

constexpr double right_angle = std::numbers::pi / 2;

std::shared_ptr<const LocalShape> shape_of(const PathWish& wish, std::uint64_t seed = 1) {
    auto plan = plan_path(wish, seed);
    EXPECT_TRUE(plan) << plan.error();
    return plan ? plan->shape : hover_shape({});
}

std::string refusal_of(const PathWish& wish) {
    const auto plan = plan_path(wish, 1);
    return plan ? "accepted" : plan.error();
}

LapWish lap_of(VehicleClass kind, double speed, unsigned laps) {
    LapWish lap;
    lap.vehicle = usual_limits(kind);
    lap.vehicle.along.speed = speed;
    lap.centre = {100, -50, 70};
    lap.laps = laps;
    return lap;
}

TEST(OrbitPlan, BeginsAtRestAndKeepsItsCircle) {
    const auto endless = shape_of(OrbitWish{lap_of(VehicleClass::multirotor, 8, 0), 40, 0.5, true, 0});
    const auto most = test::expect_path_laws(*endless, 600, 12);
    EXPECT_NEAR(most.speed, 8, 1e-6);
    for (double t = 0; t < 100; t += 7)
        EXPECT_NEAR((endless->at(t).position - Eigen::Vector3d(100, -50, 70)).norm(), 40, 1e-9);
    const auto helix = shape_of(OrbitWish{lap_of(VehicleClass::plane, 25, 6), 120, 0, false, 300});
    test::expect_path_laws(*helix, 1e6, 12);
    EXPECT_NEAR(helix->at(1e6).position.z(), 370, 1e-9);
    EXPECT_LT((helix->at(1e6).position - helix->at(0).position).head<2>().norm(), 1e-6);
}

TEST(OrbitPlan, SlowsDownOrRefuses) {
    const auto slowed = plan_orbit({lap_of(VehicleClass::car, 20, 1), 30, 0, false, 0});
    ASSERT_TRUE(slowed);
    EXPECT_THAT(slowed->notes.at(0), HasSubstr("goes at 8.66 m/s instead of 20"));
    EXPECT_THAT(refusal_of(OrbitWish{lap_of(VehicleClass::car, 5, 1), 3, 0, false, 0}),
                HasSubstr("expected at least 6"));
    EXPECT_THAT(refusal_of(OrbitWish{lap_of(VehicleClass::plane, 20, 1), 9, 0, false, 0}),
                HasSubstr("slowest of a plane"));
    EXPECT_THAT(refusal_of(OrbitWish{lap_of(VehicleClass::plane, 20, 0), 90, 0, false, 50}), HasSubstr("laps"));
}

TEST(RacetrackPlan, ComesBackToItsBeginning) {
    for (const VehicleClass kind :
         {VehicleClass::plane, VehicleClass::car, VehicleClass::boat, VehicleClass::multirotor}) {
        SCOPED_TRACE(vehicle_name(kind));
        LapWish lap = lap_of(kind, usual_limits(kind).along.speed, 3);
        lap.heading = 0.4;
        const auto shape = shape_of(RacetrackWish{lap, 250, 0});
        const auto most = test::expect_path_laws(*shape, 1e6, 20);
        EXPECT_LT((shape->at(1e6).position - shape->at(0).position).norm(), 1e-6);
        EXPECT_LE(most.acceleration, std::hypot(lap.vehicle.lateral, lap.vehicle.along.acceleration));
    }
}

TEST(FigureEightPlan, CrossesItsCentre) {
    const auto shape = shape_of(FigureEightWish{lap_of(VehicleClass::multirotor, 6, 2), 50});
    test::expect_path_laws(*shape, 1e6, 12);
    EXPECT_LT((shape->at(0).position - Eigen::Vector3d(100, -50, 70)).norm(), 1e-9);
    EXPECT_LT((shape->at(shape->duration() / 2).position - Eigen::Vector3d(100, -50, 70)).norm(), 1e-6);
    const auto slow = plan_figure_eight({lap_of(VehicleClass::multirotor, 20, 2), 15});
    ASSERT_TRUE(slow);
    EXPECT_THAT(slow->notes.at(0), HasSubstr("goes at 4.47 m/s"));
}

TEST(LawnmowerPlan, MowsEveryLine) {
    LawnmowerWish wish;
    wish.vehicle = usual_limits(VehicleClass::multirotor);
    wish.heading = right_angle;
    const auto shape = shape_of(wish);
    test::expect_path_laws(*shape, 1e6, 12);
    // The first line runs east, the others lie south of it; the fifth ends in the east.
    EXPECT_NEAR(shape->at(1e6).position.x(), 200, 1e-6);
    EXPECT_NEAR(shape->at(1e6).position.y(), -80, 1e-6);
    wish.vehicle = usual_limits(VehicleClass::plane);
    EXPECT_THAT(refusal_of(wish), HasSubstr("waypoint 2, a turn of 90°"));
}

double root_mean_square_of(const LocalShape& shape, const Eigen::Vector3d& around, Eigen::Index axis) {
    double sum = 0;
    constexpr int samples = 20000;
    for (int i = 0; i < samples; ++i)
        sum += std::pow((shape.at(10 + i * 0.37).position - around)(axis), 2);
    return std::sqrt(sum / samples);
}

TEST(HoverShape, SwaysAsMuchAsItIsTold) {
    HoverWish wish;
    wish.place = {3, 4, 120};
    wish.sway = 0.4;
    wish.wind = 8;
    const auto shape = hover_shape(wish);
    test::expect_path_laws(*shape, 3600, 20);
    EXPECT_NEAR(root_mean_square_of(*shape, wish.place, 0), 0.4, 0.02);
    EXPECT_NEAR(root_mean_square_of(*shape, wish.place, 1), 0.4, 0.02);
    EXPECT_NEAR(root_mean_square_of(*shape, wish.place, 2), 0.2, 0.01);
    EXPECT_LT(shape->at(100).pitch, -0.05) << "it leans into the wind from the north";
}

TEST(FloatShape, HeavesWithTheWavesAndDrifts) {
    FloatWish wish;
    wish.heading = right_angle;
    wish.wave_height = 1;
    const auto anchored = float_shape(wish);
    test::expect_path_laws(*anchored, 3600, 5);
    EXPECT_NEAR(root_mean_square_of(*anchored, wish.place, 2), 0.25, 0.02);
    wish.speed = 3;
    wish.current = 1;
    wish.wave_height = 0.01;
    const LocalMotion moving = float_shape(wish)->at(600);
    EXPECT_NEAR(moving.velocity.x(), 3, 0.1);
    EXPECT_NEAR(moving.velocity.y(), 1, 0.1) << "the current sets it north, and its heading stays";
    EXPECT_NEAR(moving.heading, right_angle, 0.05);
}

TEST(RocketPlan, FliesItsPhases) {
    for (const std::string_view preset : {"rocket_1km", "rocket_30km_M3"}) {
        SCOPED_TRACE(preset);
        RocketWish wish;
        wish.pad = {0, 0, 100};
        ASSERT_TRUE(choose_rocket(wish, preset));
        const auto shape = shape_of(wish);
        const auto most = test::expect_path_laws(*shape, 1e6, 4000);
        double top = 0;
        for (double t = 0; t < shape->duration(); t += 0.1)
            top = std::max(top, shape->at(t).position.z() - 100);
        const bool high = preset == "rocket_30km_M3";
        EXPECT_NEAR(top, high ? 30000 : 1000, high ? 1500 : 100);
        if (high) {
            EXPECT_GT(most.speed, 1020) << "Mach 3 at sea level";
        }
        // On the main parachute at the end.
        EXPECT_NEAR(shape->at(shape->duration() - 10).velocity.z(), -6, 0.1);
    }
    EXPECT_THAT(refusal_of(RocketWish{{0, 0, 0}, 0, 5, 3, 1e-4, 25, 6, 300}), HasSubstr("does not lift"));
}

TEST(BalloonPlan, RisesBurstsAndLands) {
    BalloonWish wish;
    wish.place = {0, 0, 200};
    ASSERT_TRUE(choose_balloon(wish, "balloon_32km"));
    const auto shape = shape_of(wish);
    const auto most = test::expect_path_laws(*shape, 1e6, 80);
    EXPECT_NEAR(most.climb, 5, 1e-3);
    EXPECT_NEAR(shape->at(6360).position.z(), 31985, 30);
    EXPECT_NEAR(shape->at(1e6).position.z(), 200, 1e-9);
    // FEEDS.md 2.5: 30 km at 6 m/s takes 2161.7 s, from rest at the top.
    wish.place.z() = 0;
    wish.burst = 30000;
    const auto lower = shape_of(wish);
    EXPECT_NEAR(lower->duration() - (30000 / 5.0 + 2.5), 2161.7, 5);
    EXPECT_THAT(refusal_of(BalloonWish{{0, 0, 3000}, 0, 5, 2000, 6, {}}), HasSubstr("bursts at 2000 m"));
    // 8000 s up and 1841 s down.
    EXPECT_THAT(refusal_of(BalloonWish{{0, 0, 0}, 0, 2.5, 20000, 6, {{0, 120, right_angle}}}),
                HasSubstr("1000 km away"));
    EXPECT_TRUE(plan_path(BalloonWish{{0, 0, 0}, 0, 2.5, 20000, 6, {{0, 80, right_angle}}}, 1));
}

DriveWish drive_of(std::uint64_t seed) {
    DriveWish wish;
    wish.vehicle = usual_limits(VehicleClass::car);
    wish.seed = seed;
    return wish;
}

TEST(DrivePlan, StaysInItsAreaForAnHour) {
    const auto shape = shape_of(drive_of(1), 5);
    test::expect_path_laws(*shape, 1e6, 15);
    EXPECT_NEAR(shape->duration(), 3600, 1500);
    for (double t = 0; t < shape->duration(); t += 1)
        EXPECT_LE(shape->at(t).position.cwiseAbs().maxCoeff(), 500.001);
    DriveWish narrow = drive_of(1);
    narrow.area = 50;
    EXPECT_THAT(refusal_of(narrow), HasSubstr("the area reaches 50 m"));
    narrow.area = 1e4;
    narrow.seconds = 1e7;
    EXPECT_THAT(refusal_of(narrow), HasSubstr("more than 20000 crossings"));
}

TEST(GeneratedPaths, TheSameSeedIsTheSamePathAndAnotherAnother) {
    for (const PathWish& wish : {PathWish(HoverWish{}), PathWish(FloatWish{}), PathWish(drive_of(0))}) {
        const auto a = shape_of(wish, 11), again = shape_of(wish, 11), other = shape_of(wish, 12);
        double apart = 0;
        for (double t = 0; t < 1000; t += 13.7) {
            EXPECT_EQ(a->at(t).position, again->at(t).position);
            apart = std::max(apart, (a->at(t).position - other->at(t).position).norm());
        }
        EXPECT_GT(apart, 0.1);
    }
}

GeneratedPath sequence_of(bool loop) {
    GeneratedPath path;
    path.vehicle = usual_limits(VehicleClass::multirotor);
    HoverWish hover;
    hover.place = {0, 0, 20};
    path.steps.push_back({hover, 30});
    path.steps.push_back({OrbitWish{lap_of(VehicleClass::multirotor, 8, 3), 40, 0.5, true, 0}, LocalShape::endless});
    hover.place = {200, 0, 20};
    path.steps.push_back({hover, 20});
    path.loop = loop;
    return path;
}

TEST(PathSequence, JoinsItsStepsWithoutAStep) {
    const auto once = plan_generated(sequence_of(false), 3);
    ASSERT_TRUE(once) << once.error();
    ASSERT_EQ(once->notes.size(), 3U);
    EXPECT_THAT(once->notes[0], HasSubstr("from step 1 to 2: joined by a curve of"));
    EXPECT_THAT(once->notes[2], HasSubstr("step 3 is left before its end"));
    test::expect_path_laws(*once->shape, 1e6, 15);
    const auto round = plan_generated(sequence_of(true), 3);
    ASSERT_TRUE(round) << round.error();
    EXPECT_TRUE(std::isinf(round->shape->duration()));
    test::expect_path_laws(*round->shape, 1000, 15);
    GeneratedPath endless = sequence_of(false);
    endless.steps[0].seconds = LocalShape::endless;
    EXPECT_EQ(plan_generated(endless, 3).error(), "step 1 has no end; expected duration_s or laps");
}

TEST(PathSequence, ALoopGoesBackToItsBeginning) {
    GeneratedPath path;
    path.vehicle = usual_limits(VehicleClass::multirotor);
    WaypointWish wish;
    wish.vehicle = path.vehicle;
    wish.waypoints = {{{0, 0, 0}, 5, 0}, {{100, 0, 10}, 5, 0}, {{100, 50, 10}, 5, 0}};
    path.steps.push_back({wish, LocalShape::endless});
    path.loop = true;
    const auto plan = plan_generated(path, 1);
    ASSERT_TRUE(plan) << plan.error();
    test::expect_path_laws(*plan->shape, 500, 15);
}

TEST(PathSequence, JointsKeepClimbAndSink) {
    GeneratedPath path;
    path.vehicle = usual_limits(VehicleClass::multirotor);
    HoverWish hover;
    hover.place = {0, 0, 700};
    path.steps.push_back({hover, 10});
    hover.place.z() = 500;
    path.steps.push_back({hover, 10});
    path.loop = true;
    const auto plan = plan_generated(path, 1);
    ASSERT_TRUE(plan) << plan.error();
    const auto most = test::expect_path_laws(*plan->shape, 1000, 15);
    EXPECT_LE(most.sink, 3 * 1.03);
    EXPECT_LE(most.climb, 5 * 1.03);
    for (double t = 0; t < 400; t += 0.5)
        EXPECT_LT(plan->shape->at(t).position.head<2>().norm(), 80) << "down and up, not far round: " << t;
    path.vehicle = usual_limits(VehicleClass::rover);
    EXPECT_THAT(plan_generated(path, 1).error(), HasSubstr("a slope of 30°"));
}

// How far from where it looks it goes, rad.
double widest_drift(const LocalShape& shape, double horizon) {
    double most = 0;
    for (double t = 0; t < std::min(horizon, shape.duration()); t += 0.05) {
        const LocalMotion m = shape.at(t);
        if (m.velocity.head<2>().norm() < 0.5) continue;
        const double course = std::atan2(m.velocity.x(), m.velocity.y());
        most = std::max(most, std::abs(std::remainder(course - m.heading, 2 * std::numbers::pi)));
    }
    return most;
}

TEST(PathSequence, PlanesAndCarsGoRoundCornersToTheNextStep) {
    GeneratedPath flight;
    flight.vehicle = usual_limits(VehicleClass::plane);
    OrbitWish orbit{lap_of(VehicleClass::plane, 20, 1), 100, 0, false, 0};
    orbit.lap.centre.z() = 900;
    flight.steps.push_back({orbit, LocalShape::endless});
    orbit.lap.centre += Eigen::Vector3d(0, 110, -400);
    flight.steps.push_back({orbit, LocalShape::endless});
    const auto plane = plan_generated(flight, 1);
    ASSERT_TRUE(plane) << plane.error();
    EXPECT_THAT(plane->notes.at(0), HasSubstr("from step 1 to 2: joined by a way round corners of"));
    EXPECT_LE(test::expect_path_laws(*plane->shape, 1e6, 30).sink, 4.001);
    EXPECT_LT(widest_drift(*plane->shape, 1e6), 0.01);
    GeneratedPath drive;
    drive.vehicle = usual_limits(VehicleClass::car);
    WaypointWish wish;
    wish.vehicle = drive.vehicle;
    wish.waypoints = {{{0, 0, 0}, 14, 0}, {{0, 200, 0}, 14, 0}, {{200, 200, 0}, 14, 0}};
    drive.steps.push_back({wish, LocalShape::endless});
    drive.loop = true;
    const auto car = plan_generated(drive, 1);
    ASSERT_TRUE(car) << car.error();
    test::expect_path_laws(*car->shape, 300, 20);
    EXPECT_LT(widest_drift(*car->shape, 300), 0.01);
}

// The jerk along its way, 1 m/s³, is less than that with which its turn ends.
TEST(PathSequence, APlaneLeavesItsCircle) {
    GeneratedPath path;
    path.vehicle = usual_limits(VehicleClass::plane);
    path.steps.push_back({OrbitWish{lap_of(VehicleClass::plane, 20, 0), 100, 0, false, 0}, 60});
    const auto plan = plan_generated(path, 1);
    ASSERT_TRUE(plan) << plan.error();
    EXPECT_THAT(plan->notes.at(0), HasSubstr("step 1 is left before its end: joined by a curve of"));
    EXPECT_LE(test::expect_path_laws(*plan->shape, 1e6, 30).speed, 20 * 1.03);
}

TEST(PathSequence, SaysWhereACarCannotGoRound) {
    GeneratedPath path;
    path.vehicle = usual_limits(VehicleClass::car);
    OrbitWish orbit{lap_of(VehicleClass::car, 8, 1), 30, 0, false, 0};
    path.steps.push_back({orbit, LocalShape::endless});
    orbit.lap.centre.z() += 5000;
    path.steps.push_back({orbit, LocalShape::endless});
    EXPECT_THAT(plan_generated(path, 1).error(),
                HasSubstr("from step 1 to 2: a car, which does not turn where it stands, finds no way of 0 m"));
}

// On the far side of its circle, away from the place and at full speed.
TEST(PathSequence, StopsFirstWhereNoOneCurveKeepsTheLimits) {
    GeneratedPath path;
    path.vehicle = usual_limits(VehicleClass::multirotor);
    path.vehicle.along.speed = 8;
    path.steps.push_back({OrbitWish{lap_of(VehicleClass::multirotor, 8, 0), 35, 0, false, 0}, 60});
    HoverWish hover;
    hover.place = {100, 105, 70};
    path.steps.push_back({hover, 5});
    const auto plan = plan_generated(path, 1);
    ASSERT_TRUE(plan) << plan.error();
    ASSERT_GE(plan->notes.size(), 2U);
    EXPECT_THAT(plan->notes[0], HasSubstr("from step 1 to 2, to a stop: joined by a curve of"));
    EXPECT_THAT(plan->notes[1], HasSubstr("from step 1 to 2, from the stop on: joined by a curve of"));
    const auto most = test::expect_path_laws(*plan->shape, 1e6, 15);
    EXPECT_LE(most.speed, 8 * 1.03);
}

// The sharpest change of an angle's rate, rad/s².
double sharpest_change(const LocalShape& shape, double LocalMotion::*angle, double end) {
    constexpr double step_s = 1e-3;
    double most = 0;
    for (double t = step_s; t < end; t += step_s) {
        const double now = shape.at(t).*angle;
        const double before = std::remainder(now - shape.at(t - step_s).*angle, 2 * std::numbers::pi),
                     after = std::remainder(shape.at(t + step_s).*angle - now, 2 * std::numbers::pi);
        most = std::max(most, std::abs(after - before) / (step_s * step_s));
    }
    return most;
}

TEST(PathSequence, LeavesATurnAndASwellWithoutAStepOfItsTurnRate) {
    GeneratedPath path;
    path.vehicle = usual_limits(VehicleClass::multirotor);
    path.steps.push_back({OrbitWish{lap_of(VehicleClass::multirotor, 8, 0), 35, 0, false, 0}, 33.3});
    HoverWish hover;
    hover.place = {100, -50, 70};
    path.steps.push_back({hover, 5});
    const auto orbit = plan_generated(path, 1);
    ASSERT_TRUE(orbit) << orbit.error();
    EXPECT_NEAR(orbit->shape->at(33.31).heading - orbit->shape->at(33.3).heading, 0.01 * 8 / 35, 1e-4);
    EXPECT_LT(sharpest_change(*orbit->shape, &LocalMotion::heading, orbit->shape->duration()), 3);
    path.steps[0] = {FloatWish{}, 20};
    path.steps[1] = {HoverWish{}, 5};
    const auto swell = plan_generated(path, 1);
    ASSERT_TRUE(swell) << swell.error();
    for (double LocalMotion::*angle : {&LocalMotion::heading, &LocalMotion::roll, &LocalMotion::pitch})
        EXPECT_LT(sharpest_change(*swell->shape, angle, swell->shape->duration()), 5);
}

TEST(PathSequence, LeavesATurnOnTheSpotWithoutAStepOfItsTurnRate) {
    GeneratedPath path;
    WaypointWish wish;
    wish.waypoints = {{{0, 0, 0}, 5, 0}, {{0, 33, 0}, 5, 0}, {{0, 0, 0}, 5, 0}};
    path.steps.push_back({wish, LocalShape::endless});
    const auto whole = plan_generated(path, 1);
    ASSERT_TRUE(whole) << whole.error();
    double turning = 0;
    while (turning < whole->shape->duration() && std::abs(whole->shape->at(turning).heading) < right_angle)
        turning += 0.01;
    ASSERT_LT(whole->shape->at(turning).velocity.norm(), 1e-9);
    path.steps[0].seconds = turning;
    const auto cut = plan_generated(path, 1);
    ASSERT_TRUE(cut) << cut.error();
    EXPECT_GT(cut->shape->duration(), turning) << "the turn runs out";
    EXPECT_LT(sharpest_change(*cut->shape, &LocalMotion::heading, cut->shape->duration()), 20);
}

// It comes back to where it began, and looks the other way.
TEST(PathSequence, ALoopTurnsOnTheSpotNoFasterThanAtAWaypoint) {
    GeneratedPath path;
    WaypointWish wish;
    wish.waypoints = {{{0, 0, 0}, 5, 0}, {{0, 33, 0}, 5, 0}, {{0, 0, 0}, 5, 0}};
    path.steps.push_back({wish, LocalShape::endless});
    path.loop = true;
    const auto plan = plan_generated(path, 1);
    ASSERT_TRUE(plan) << plan.error();
    EXPECT_LT(test::fastest_yaw(*plan->shape, 100), right_angle * 1.01) << "90° a second";
}

}  // namespace
}  // namespace skyloop
