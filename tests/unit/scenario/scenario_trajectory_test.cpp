// Trajectories as scenario files and files of their own give them, on the Earth and in a game level.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/geo/local_frame.hpp"
#include "scenario_text.hpp"

namespace skyloop {
namespace {

using test::mistakes_of;
using test::scenario_of;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr std::string_view level_at_odessa = "[frame]\norigin = [46.4774, 30.7326, 50]\n";

Geodetic fixed_place(const std::string& text) {
    const Scenario s = scenario_of(text);
    EXPECT_TRUE(std::holds_alternative<FixedSettings>(s.trajectory));
    return std::holds_alternative<FixedSettings>(s.trajectory) ? std::get<FixedSettings>(s.trajectory).at : Geodetic{};
}

// East, north and up of `place` seen from the frame's origin in level_at_odessa, m.
Eigen::Vector3d from_odessa(const Geodetic& place) {
    return LocalFrame(Geodetic::degrees(46.4774, 30.7326, 50)).to_enu(to_ecef(place)).vector();
}

void expect_near(const Eigen::Vector3d& found, const Eigen::Vector3d& expected) {
    EXPECT_LT((found - expected).norm(), 1e-6) << found.transpose() << " instead of " << expected.transpose();
}

TEST(ScenarioTrajectory, APlaceHasTwoOrThreeNumbers) {
    const Geodetic three = fixed_place("[trajectory]\nkind = \"fixed\"\nat = [-10.5, 170, 123.5]");
    EXPECT_NEAR(three.latitude.deg(), -10.5, 1e-12);
    EXPECT_NEAR(three.longitude.deg(), 170, 1e-12);
    EXPECT_EQ(three.height.above_ellipsoid, Metres(123.5));
    const Geodetic two = fixed_place("[trajectory]\nkind = \"fixed\"\nat = [46, 200]");
    EXPECT_NEAR(two.longitude.deg(), -160, 1e-12) << "a longitude may be counted to 360";
    EXPECT_EQ(two.height.above_ellipsoid, Metres(0));
}

TEST(ScenarioTrajectory, TheOriginOfATrackMayBeAPlaceOfTheLevel) {
    const Scenario s = scenario_of(std::string(level_at_odessa) +
                                   "[trajectory]\nkind = \"file\"\npath = \"track.csv\"\norigin_level = [0, 0, 0]\n");
    const auto& file = std::get<FileSettings>(s.trajectory);
    ASSERT_TRUE(file.origin);
    expect_near(from_odessa(*file.origin), {0, 0, 0});
    EXPECT_THAT(mistakes_of("[trajectory]\nkind = \"file\"\npath = \"track.csv\"\norigin_level = [0, 0, 0]\n"),
                HasSubstr("trajectory.origin_level: needs a [frame]"));
}

TEST(ScenarioTrajectory, WaypointsInheritTheSpeedOfTheOneBefore) {
    const Scenario s = scenario_of(R"toml(
[trajectory]
kind = "waypoints"
[[trajectory.waypoint]]
at = [46, 30, 0]
[[trajectory.waypoint]]
at = [46.001, 30, 10]
speed_mps = 3
hold_s = 4
[[trajectory.waypoint]]
at = [46.002, 30, 20]
)toml");
    const auto& corners = std::get<WaypointSettings>(s.trajectory).corners;
    ASSERT_THAT(corners, SizeIs(3));
    EXPECT_EQ(corners[0].speed, MetresPerSecond(10));
    EXPECT_EQ(corners[1].speed, MetresPerSecond(3));
    EXPECT_EQ(corners[2].speed, MetresPerSecond(3));
    EXPECT_EQ(corners[1].hold, Seconds(4));
    EXPECT_EQ(corners[2].hold, Seconds(0)) << "a hold is not inherited";
    EXPECT_NEAR(corners[2].place.latitude.deg(), 46.002, 1e-12);
}

TEST(ScenarioTrajectory, ACircleHasDefaults) {
    const auto shape =
        std::get<CircleSettings>(scenario_of("[trajectory]\nkind = \"circle\"\ncentre = [46, 30, 5]").trajectory).shape;
    EXPECT_EQ(shape.radius, Metres(100));
    EXPECT_EQ(shape.speed, MetresPerSecond(10));
    EXPECT_EQ(shape.start_azimuth.rad(), 0);
}

TEST(ScenarioTrajectory, LevelPointsLieWhereTheFrameSays) {
    const std::string frame(level_at_odessa);
    const std::string fixed = "[trajectory]\nkind = \"fixed\"\nat_level = [100, 20, 3]";
    // X to the north, Y to its left.
    expect_near(from_odessa(fixed_place(frame + fixed)), {-20, 100, 3});
    expect_near(from_odessa(fixed_place(frame + "left_handed = true\n" + fixed)), {20, 100, 3});
    // X to the east, Y to the north.
    expect_near(from_odessa(fixed_place(frame + "yaw_deg = 90\n" + fixed)), {100, 20, 3});
    expect_near(from_odessa(fixed_place(frame + "unit_m = 0.01\n" + fixed)), {-0.2, 1, 0.03});
    // [frame] may stand after [trajectory].
    expect_near(from_odessa(fixed_place(fixed + "\n" + frame)), {-20, 100, 3});
}

TEST(ScenarioTrajectory, EveryKindTakesLevelPoints) {
    const std::string frame(level_at_odessa);
    const auto circle = scenario_of(frame + "[trajectory]\nkind = \"circle\"\ncentre_level = [7, 0, 0]").trajectory;
    expect_near(from_odessa(std::get<CircleSettings>(circle).shape.centre), {0, 7, 0});
    const auto path = scenario_of(frame + R"toml(
[trajectory]
kind = "waypoints"
waypoint = [{ at_level = [0, 0, 0] }, { at_level = [0, -50, 10] }]
)toml");
    expect_near(from_odessa(std::get<WaypointSettings>(path.trajectory).corners.at(1).place), {50, 0, 10});
}

TEST(ScenarioTrajectory, WarnsOfAPhysicsLinkWithoutAnOrigin) {
    const auto warnings = [](const std::string& live) {
        return scenario_of("[trajectory]\nkind = \"live\"\n" + live).warnings;
    };
    const std::string physics = "source = \"ardupilot-json:9002,127.0.0.1:9012\"\n";
    EXPECT_THAT(warnings(physics),
                testing::ElementsAre(HasSubstr("ardupilot-json:9002,127.0.0.1:9012: [trajectory] has "
                                               "no origin")));
    EXPECT_THAT(warnings(physics + "origin = [-35, 149, 600]\n"), IsEmpty());
    EXPECT_THAT(warnings("source = \"udp-json:29990\"\n"), IsEmpty());
}

TEST(ScenarioTrajectory, WarnsOfPointsBeyondTheReachOfAPlane) {
    const std::string frame(level_at_odessa);
    const auto warnings = [&](const std::string& point, const std::string& more = "") {
        return scenario_of(frame + more + "[trajectory]\nkind = \"fixed\"\nat_level = " + point).warnings;
    };
    EXPECT_THAT(warnings("[3999, 0, 9000]"), IsEmpty()) << "height is no distance from the origin of a plane";
    const auto beyond = warnings("[3000, 3000, 0]");
    ASSERT_THAT(beyond, SizeIs(1));
    EXPECT_THAT(beyond[0], HasSubstr("lies 4243 m from the frame's origin; beyond 4000 m"));
    EXPECT_THAT(beyond[0], HasSubstr("by 1.4 m there"));
    EXPECT_THAT(warnings("[3000, 3000, 0]", "reach_m = 5000\n"), IsEmpty());
    EXPECT_THAT(warnings("[300000, 300000, 0]", "unit_m = 0.01\n"), SizeIs(1));
}

TEST(ScenarioTrajectory, RefusesLevelPointsOutOfTheWorld) {
    const std::string frame(level_at_odessa);
    for (const char* point : {"[1e300, 0, 0]", "[2e7, 0, 0]", "[0, 0, -20000]", "[0, 0, 1.5e7]"})
        EXPECT_THAT(mistakes_of(frame + "[trajectory]\nkind = \"fixed\"\nat_level = " + point),
                    HasSubstr("test.toml:5:12: trajectory.at_level: height is"))
            << point;
}

TEST(ScenarioTrajectory, RefusesIncompletePaths) {
    for (const char* keys : {"at = [46, 30]", "kind = \"fxed\"\nat = [46, 30]"})
        EXPECT_THAT(mistakes_of(std::string("[trajectory]\n") + keys),
                    testing::AllOf(testing::AnyOf(HasSubstr("has no kind"), HasSubstr("did you mean 'fixed'?")),
                                   testing::Not(HasSubstr("unknown key"))));
    EXPECT_THAT(mistakes_of("[trajectory]\nkind = \"\"\nat = [46, 30]"),
                HasSubstr("test.toml:2:8: trajectory.kind: is ''"));
    EXPECT_THAT(mistakes_of("[trajectory]\nkind = \"fixed\""),
                HasSubstr("[trajectory] has no place; expected at = [latitude, longitude"));
    EXPECT_THAT(mistakes_of("[trajectory]\nkind = \"circle\""), HasSubstr("[trajectory] has no centre"));
    EXPECT_THAT(mistakes_of("[trajectory]\nkind = \"waypoints\""), HasSubstr("has 0 waypoints; expected two or more"));
    EXPECT_THAT(mistakes_of("[trajectory]\nkind = \"waypoints\"\nwaypoint = [{ at = [1, 2] }]"),
                HasSubstr("has 1 waypoints; expected two or more"));
    EXPECT_THAT(mistakes_of("[trajectory]\nkind = \"waypoints\"\nwaypoint = [{ at = [1, 2] }, { hold_s = 1 }]"),
                HasSubstr("[trajectory.waypoint] has no place"));
    EXPECT_THAT(mistakes_of("[trajectory]\nkind = \"file\""), HasSubstr("no path; expected path = \"track.csv\""));
    EXPECT_THAT(mistakes_of("[trajectory]\nkind = \"file\"\npath = \"x.csv\"\ntime = \"mine\""),
                HasSubstr("trajectory.time"));
    EXPECT_THAT(mistakes_of("[trajectory]\nkind = \"file\"\npath = \"x.csv\"\ngap_s = nan"),
                HasSubstr("trajectory.gap_s"));
    EXPECT_THAT(mistakes_of("[frame]\nyaw_deg = 3"), HasSubstr("[frame] has no origin"));
    const std::string live = "kind = \"live\"\nsource = \"udp-json:0\"\n";
    EXPECT_EQ(mistakes_of("[frame]\norigin = [1, 2, 3]\n[trajectory]\n" + live),
              "test.toml:1:1: frame: has no effect on a live trajectory; expected no [frame], and trajectory.origin "
              "where the source gives local metres");
    EXPECT_THAT(mistakes_of("[frame]\norigin = [1, 2, 3]\n[[receiver]]\n[receiver.trajectory]\n" + live),
                HasSubstr("frame: has no effect on a live trajectory"));
    EXPECT_THAT(mistakes_of("[trajectory]\n" + live + "origin_level = [0, 0, 0]\n"),
                HasSubstr("trajectory.origin_level: unknown key"));
    EXPECT_EQ(mistakes_of("[frame]\norigin = [1, 2, 3]\n[trajectory]\nkind = \"fixed\"\nat_level = [0, 0, 0]\n"
                          "[[receiver]]\n[[receiver]]\n[receiver.trajectory]\n" +
                          live),
              "accepted")
        << "the frame is of use to the first receiver";
}

TEST(ScenarioTrajectory, RefusesTwoPlacesAndALevelWithoutAFrame) {
    EXPECT_EQ(mistakes_of("[trajectory]\nkind = \"fixed\"\nat_level = [1, 2, 3]"),
              "test.toml:3:12: trajectory.at_level: needs a [frame] that says where the level lies");
    EXPECT_EQ(mistakes_of(std::string(level_at_odessa) +
                          "[trajectory]\nkind = \"fixed\"\nat = [46, 30]\nat_level = [1, 2, 3]"),
              "test.toml:6:12: trajectory.at_level: stands beside at; expected one of the two");
}

TEST(TrajectoryFile, IsReadByItself) {
    const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "skyloop-trajectory-file.toml";
    std::vector<std::string> warnings;
    const auto read = [&](const std::string& text) {
        std::ofstream(file) << text;
        return read_trajectory_file(file, warnings);
    };
    const auto path = read(std::string(level_at_odessa) + "[trajectory]\nkind = \"fixed\"\nat_level = [10, 0, 0]");
    ASSERT_TRUE(path) << path.error().message;
    expect_near(from_odessa(std::get<FixedSettings>(*path).at), {0, 10, 0});
    EXPECT_THAT(warnings, IsEmpty());
    ASSERT_TRUE(read(std::string(level_at_odessa) + "[trajectory]\nkind = \"fixed\"\nat_level = [100000, 0, 0]"));
    EXPECT_THAT(warnings, ElementsAre(HasSubstr("anchor the frame nearer")));
    EXPECT_THAT(read("[frame]\norigin = [1, 2, 3]").error().message, HasSubstr("no [trajectory] table in this file"));
    EXPECT_THAT(read("[trajectory]\nkind = \"fixed\"\nat = [1, 2]\n[run]\nseed = 1").error().message,
                HasSubstr(":4:2: run: unknown key"));
    EXPECT_THAT(read("[trajectory").error().message, HasSubstr("skyloop-trajectory-file.toml:1:"));
    std::filesystem::remove(file);
    EXPECT_EQ(read_trajectory_file(file, warnings).error().code, ErrorCode::outside);
}

}  // namespace
}  // namespace skyloop
