// Generated paths in scenarios: what their keys mean, and what the reader says of those that cannot be.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenario_text.hpp"

namespace skyloop {
namespace {

using test::mistakes_of;
using test::scenario_of;
using testing::HasSubstr;

GeneratedSettings generated_of(std::string_view text) {
    const Scenario scenario = scenario_of(text);
    EXPECT_TRUE(std::holds_alternative<GeneratedSettings>(scenario.trajectory)) << text;
    if (!std::holds_alternative<GeneratedSettings>(scenario.trajectory)) return {};
    return std::get<GeneratedSettings>(scenario.trajectory);
}

constexpr std::string_view three_waypoints = R"toml(
[[trajectory.waypoint]]
at = [47, 8, 500]
[[trajectory.waypoint]]
at = [47.005, 8, 520]
hold_s = 4
[[trajectory.waypoint]]
at = [47.005, 8.005, 520]
speed_mps = 3
)toml";

std::string waypoints_with(std::string_view keys) {
    return "[trajectory]\nkind = \"waypoints\"\n" + std::string(keys) + std::string(three_waypoints);
}

TEST(ScenarioPaths, WaypointsWithoutAVehicleAreAsBefore) {
    const Scenario scenario = scenario_of(waypoints_with(""));
    ASSERT_TRUE(std::holds_alternative<WaypointSettings>(scenario.trajectory));
    EXPECT_EQ(std::get<WaypointSettings>(scenario.trajectory).corners.at(0).speed, MetresPerSecond(10));
}

TEST(ScenarioPaths, WaypointsWithAVehicleAreDriven) {
    const GeneratedSettings path = generated_of(waypoints_with("vehicle = \"multirotor\"\nlateral_mps2 = 2\n"));
    ASSERT_TRUE(path.shape);
    EXPECT_EQ(path.path.vehicle.lateral, 2);
    EXPECT_EQ(path.path.vehicle.along.jerk, usual_limits(VehicleClass::multirotor).along.jerk);
    const auto& wish = std::get<WaypointWish>(path.path.steps.at(0).wish);
    EXPECT_EQ(wish.waypoints.at(0).speed, 12);
    EXPECT_EQ(wish.waypoints.at(1).hold, 4);
    EXPECT_EQ(wish.waypoints.at(2).speed, 3);
    EXPECT_NEAR(wish.waypoints.at(1).place.y(), 556, 1);
    const GeneratedSettings plane =
        generated_of(waypoints_with("slowest_mps = 0\nvehicle = \"plane\"\nbank_deg = 30\n"
                                    "loop = true\nstart_delay_s = 7"));
    EXPECT_NEAR(plane.path.vehicle.lateral, 9.80665 * 0.57735, 1e-3);
    EXPECT_TRUE(plane.path.loop);
    EXPECT_EQ(plane.path.start_delay, Seconds(7));
}

TEST(ScenarioPaths, EveryKindReadsItsKeys) {
    const auto kind = [](std::string_view name, std::string_view keys) {
        return "[trajectory]\nkind = \"" + std::string(name) + "\"\n" + std::string(keys);
    };
    EXPECT_NEAR(generated_of(kind("orbit", "centre = [47, 8, 500]\nradius_m = 80\nlaps = 2\nanticlockwise = true"))
                    .shape->at(0)
                    .position.y(),
                80, 1e-9);
    EXPECT_GT(generated_of(kind("racetrack", "centre = [47, 8, 500]\nvehicle = \"plane\"\nlaps = 1\nlength_m = 500"))
                  .shape->duration(),
              60);
    EXPECT_NEAR(std::get<FigureEightWish>(
                    generated_of(kind("figure-eight", "centre = [47, 8, 500]\nlength_m = 90")).path.steps.at(0).wish)
                    .half_length,
                45, 1e-9);
    EXPECT_EQ(
        std::get<LawnmowerWish>(generated_of(kind("lawnmower", "at = [47, 8, 500]\nlines = 3")).path.steps.at(0).wish)
            .lines,
        3U);
    EXPECT_EQ(generated_of(kind("hover", "at = [47, 8, 500]\nseed = 9")).path.seed, 9U);
    EXPECT_EQ(generated_of(kind("float", "at = [47, 8, 0]\nwave_height_m = 2")).path.vehicle.kind, VehicleClass::boat);
    EXPECT_EQ(generated_of(kind("drive", "centre = [47, 8, 0]\narea_m = 300")).path.vehicle.kind, VehicleClass::car);
    const RocketWish rocket = std::get<RocketWish>(
        generated_of(kind("rocket", "at = [28, -80, 3]\npreset = \"rocket_1km\"\nburn_s = 3")).path.steps.at(0).wish);
    EXPECT_EQ(rocket.boost, 70);
    EXPECT_EQ(rocket.burn, 3);
    const BalloonWish balloon =
        std::get<BalloonWish>(generated_of(kind("balloon",
                                                "at = [28, -80, 3]\n[[trajectory.wind]]\nheight_m = 0\n"
                                                "speed_mps = 4\nto_deg = 90"))
                                  .path.steps.at(0)
                                  .wish);
    EXPECT_EQ(balloon.winds.at(0).speed, 4);
}

constexpr std::string_view sequence = R"toml(
[trajectory]
kind = "sequence"
vehicle = "multirotor"
speed_mps = 8
[[trajectory.step]]
kind = "hover"
at = [47, 8, 500]
duration_s = 20
[[trajectory.step]]
kind = "orbit"
centre = [47.001, 8, 520]
radius_m = 50
laps = 2
[[trajectory.step]]
kind = "waypoints"
[[trajectory.step.waypoint]]
at = [47.001, 8.001, 520]
[[trajectory.step.waypoint]]
at = [47, 8, 500]
)toml";

TEST(ScenarioPaths, ASequenceHasItsSteps) {
    const GeneratedSettings path = generated_of(sequence);
    ASSERT_EQ(path.path.steps.size(), 3U);
    EXPECT_EQ(path.path.steps[0].seconds, 20);
    EXPECT_EQ(std::get<OrbitWish>(path.path.steps[1].wish).lap.vehicle.along.speed, 8);
    EXPECT_EQ(std::get<WaypointWish>(path.path.steps[2].wish).waypoints.at(0).speed, 8);
    EXPECT_LT(path.shape->at(1e5).position.head<2>().norm(), 1e-6) << "it ends where it began";
}

TEST(ScenarioPaths, AStepHasItsOwnVehicle) {
    const GeneratedSettings path = generated_of(
        "[trajectory]\nkind = \"sequence\"\nvehicle = \"rover\"\n"
        "[[trajectory.step]]\nkind = \"rocket\"\nat = [28, -80, 3]\npreset = \"rocket_1km\"\n"
        "[[trajectory.step]]\nkind = \"orbit\"\ncentre = [28, -80, 3]\nradius_m = 90\nlaps = 1\n"
        "[[trajectory.step]]\nkind = \"drive\"\ncentre = [28, -80, 3]\n");
    ASSERT_EQ(path.path.steps.size(), 3U);
    EXPECT_EQ(path.path.steps[0].vehicle->kind, VehicleClass::rocket);
    EXPECT_EQ(path.path.steps[1].vehicle->kind, VehicleClass::rover);
    EXPECT_EQ(path.path.steps[2].vehicle->kind, VehicleClass::car);
    EXPECT_EQ(path.path.vehicle.kind, VehicleClass::rover);
}

TEST(ScenarioPaths, TellsWhatCannotBe) {
    EXPECT_THAT(mistakes_of("[trajectory]\nkind = \"orbit\""), HasSubstr("has no centre; expected centre = [latitude"));
    EXPECT_THAT(mistakes_of("[trajectory]\nkind = \"orbit\"\ncentre = [47, 8]\nvehicle = \"plane\"\nradius_m = 5"),
                HasSubstr("test.toml:1:1: [trajectory] its tightest turn, of 5.0 m radius, allows 7 m/s"));
    EXPECT_THAT(mistakes_of(waypoints_with("vehicle = \"plane\"")),
                HasSubstr("waypoint 2: holds for 4 s, and a plane cannot stop on its way"));
    EXPECT_THAT(mistakes_of("[trajectory]\nkind = \"sequence\""), HasSubstr("has no steps"));
    EXPECT_THAT(mistakes_of("[trajectory]\nkind = \"sequence\"\n[[trajectory.step]]\nkind = \"hover\"\nat = [1, 2]\n"
                            "[[trajectory.step]]\nkind = \"hover\"\nat = [1, 2]"),
                HasSubstr("step 1 has no end"));
    EXPECT_THAT(mistakes_of("[trajectory]\nkind = \"sequence\"\n[[trajectory.step]]\nkind = \"sequence\""),
                HasSubstr("trajectory.step.kind: is 'sequence'; expected one of waypoints orbit"));
    EXPECT_THAT(mistakes_of("[trajectory]\nkind = \"waypoints\"\nvehicle = \"car\"\n[[trajectory.waypoint]]\nat = "
                            "[1, 2]\n[[trajectory.waypoint]]\nat = [40, 2]"),
                HasSubstr("km from the first place of the path; expected at most 1000"));
    EXPECT_THAT(mistakes_of("[trajectory]\nkind = \"hover\"\nat = [1, 2]\nbank_deg = 3"), HasSubstr("unknown key"));
    EXPECT_THAT(mistakes_of(waypoints_with("bank_deg = 30\nlateral_mps2 = 3")), HasSubstr("expected one of the two"));
}

}  // namespace
}  // namespace skyloop
