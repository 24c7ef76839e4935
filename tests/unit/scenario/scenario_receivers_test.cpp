// [[receiver]]: several of them, their names, antennas, bases and memories.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenario_text.hpp"

namespace skyloop {
namespace {

using test::mistakes_of;
using test::scenario_of;
using testing::HasSubstr;

TEST(ScenarioReceivers, EachHasItsOwnKeys) {
    const Scenario s = scenario_of(
        "[[receiver]]\nport = [\"uart1=pty:a\", \"uart2=file:x\"]\n"
        "[[receiver]]\nname = \"rear\"\nboard = \"ublox-f9p\"\nantenna_offset_m = [-0.5, 0.25, -1]\n");
    ASSERT_EQ(s.receivers.size(), 2U);
    EXPECT_EQ(s.receivers[0].board, "ublox-m8");
    EXPECT_EQ(s.receivers[1].board, "ublox-f9p");
    EXPECT_THAT(s.receivers[0].ports, testing::ElementsAre("uart1=pty:a", "uart2=file:x"));
    EXPECT_TRUE(s.receivers[1].ports.empty());
    EXPECT_THAT(s.receivers[0].antenna_offset, testing::ElementsAre(0, 0, 0));
    EXPECT_THAT(s.receivers[1].antenna_offset, testing::ElementsAre(-0.5, 0.25, -1));
    EXPECT_EQ(receiver_name(s, 0), "receiver0");
    EXPECT_EQ(receiver_name(s, 1), "rear");
    EXPECT_EQ(scenario_of("").receivers.size(), 1U) << "one, without any table";
}

TEST(ScenarioReceivers, PowerAndMemory) {
    const ReceiverEntry plain = scenario_of("[[receiver]]").receivers[0];
    EXPECT_FALSE(plain.power_up);
    EXPECT_TRUE(plain.state_file.empty());
    const ReceiverEntry r =
        scenario_of("[[receiver]]\npower_up = true\nstate_file = \"gps.state\"\nstart = \"cold\"").receivers[0];
    EXPECT_TRUE(r.power_up);
    EXPECT_EQ(r.state_file, std::filesystem::path("folder/gps.state")) << "beside the scenario";
    EXPECT_EQ(r.start, StartKind::cold);
}

TEST(ScenarioReceivers, ABoardByItsPathLiesBesideTheScenario) {
    const auto board = [](const std::string& named) {
        return scenario_of("[[receiver]]\nboard = \"" + named + "\"\n").receivers[0].board;
    };
    EXPECT_EQ(board("mine.toml"), "folder/mine.toml");
    EXPECT_EQ(board("boards/mine.toml"), "folder/boards/mine.toml");
    EXPECT_EQ(board("/boards/mine.toml"), "/boards/mine.toml");
    EXPECT_EQ(board("ublox-m10"), "ublox-m10") << "a name is looked for where boards lie";
}

TEST(ScenarioReceivers, ItemsOfTheConfigurationByTheirNames) {
    const ReceiverEntry r = scenario_of(
                                "[[receiver]]\n[receiver.config]\n\"CFG-RATE-MEAS\" = 100\n"
                                "\"CFG-ITFM-ENABLE\" = true\nCFG-NAVSPG-INFIL_MINELEV = -5\n")
                                .receivers[0];
    EXPECT_THAT(r.config,
                testing::UnorderedElementsAre(testing::Pair(0x30210001U, 100U), testing::Pair(0x1041000DU, 1U),
                                              testing::Pair(0x201100A4U, 0xFBU)));
    EXPECT_TRUE(scenario_of("[[receiver]]").receivers[0].config.empty());
    EXPECT_THAT(mistakes_of("[[receiver]]\n[receiver.config]\n\"CFG-RATE-MES\" = 100\n"),
                HasSubstr("test.toml:3:18: receiver.config.CFG-RATE-MES: is no configuration item; did you mean "
                          "'CFG-RATE-MEAS'?"));
    EXPECT_THAT(mistakes_of("[[receiver]]\n[receiver.config]\n\"CFG-RATE-MEAS\" = 70000\n"),
                HasSubstr("CFG-RATE-MEAS: is 70000; expected a whole number from 0 to 65535"));
    EXPECT_THAT(mistakes_of("[[receiver]]\n[receiver.config]\n\"CFG-RATE-MEAS\" = \"fast\"\n"),
                HasSubstr("CFG-RATE-MEAS: is a text; expected"));
    EXPECT_THAT(mistakes_of("[[receiver]]\nconfig = 3\n"), HasSubstr("config"));
}

TEST(ScenarioReceivers, ItemsThatHoldFloatingPointTakeNumbers) {
    const auto item = [](const std::string& line) {
        return scenario_of("[[receiver]]\n[receiver.config]\n" + line + "\n").receivers[0].config;
    };
    using testing::ElementsAre, testing::Pair;
    EXPECT_THAT(item("CFG-NAVSPG-USRDAT_DX = 1.5"), ElementsAre(Pair(0x40110064U, 0x3FC00000U)));
    EXPECT_THAT(item("CFG-NAVSPG-USRDAT_DY = 2"), ElementsAre(Pair(0x40110065U, 0x40000000U)));
    EXPECT_THAT(item("CFG-NAVSPG-USRDAT_DZ = -3"), ElementsAre(Pair(0x40110066U, 0xC0400000U)));
    EXPECT_THAT(item("CFG-NAVSPG-USRDAT_FLAT = 0.5"), ElementsAre(Pair(0x50110063U, 0x3FE0000000000000U)));
    EXPECT_THAT(mistakes_of("[[receiver]]\n[receiver.config]\nCFG-NAVSPG-USRDAT_DX = 1e39\n"),
                HasSubstr("CFG-NAVSPG-USRDAT_DX: is 1e+39; expected a number from -3.4"));
}

TEST(ScenarioReceivers, ABaseIsNamedOrCounted) {
    const std::string named =
        "[[receiver]]\nbase = \"rear\"\n[[receiver]]\nname = \"rear\"\n[[receiver]]\nbase = \"receiver0\"";
    const Scenario s = scenario_of(named);
    EXPECT_EQ(s.receivers[0].base, 1U) << "that stands behind its rover";
    EXPECT_FALSE(s.receivers[1].base);
    EXPECT_EQ(s.receivers[2].base, 0U);
}

TEST(ScenarioReceivers, ABaseThatIsNotThereIsRefused) {
    EXPECT_THAT(mistakes_of("[[receiver]]\nbase = \"reer\"\n[[receiver]]\nname = \"rear\""),
                testing::AllOf(HasSubstr("test.toml:2:"), HasSubstr("receiver.base: 'reer' is no receiver"),
                               HasSubstr("expected one of receiver0, rear")));
    EXPECT_THAT(mistakes_of("[[receiver]]\nbase = \"receiver0\""), HasSubstr("is this receiver itself"));
    EXPECT_THAT(mistakes_of("[[receiver]]\nbase = 1"), HasSubstr("receiver.base"));
}

TEST(ScenarioReceivers, NamesAreThereAndDiffer) {
    EXPECT_THAT(mistakes_of("[[receiver]]\nname = \"a\"\n[[receiver]]\nname = \"a\""),
                testing::AllOf(HasSubstr("test.toml:3:1"), HasSubstr("second receiver called 'a'")));
    EXPECT_THAT(mistakes_of("[[receiver]]\n[[receiver]]\nname = \"receiver0\""),
                HasSubstr("second receiver called 'receiver0'"));
    EXPECT_THAT(mistakes_of("[[receiver]]\nname = \"\""), HasSubstr("receiver.name: is empty"));
}

TEST(ScenarioReceivers, LeverArmsAreThreeNumbersOfAVehiclesSize) {
    EXPECT_THAT(mistakes_of("[[receiver]]\nantenna_offset_m = [1, 2]"), HasSubstr("antenna_offset_m"));
    EXPECT_THAT(mistakes_of("[[receiver]]\nantenna_offset_m = [1, 2, 1001]"),
                HasSubstr("antenna_offset_m: is [1, 2, 1001]; expected numbers from -1000 to 1000"));
    EXPECT_THAT(mistakes_of("[[receiver]]\nantenna_offset_m = [nan, 0, 0]"), HasSubstr("antenna_offset_m"));
}

TEST(ScenarioReceivers, TheHeadingBelongsToEveryKindOfPath) {
    const auto heading = [](const std::string& keys) {
        return std::visit([](const auto& path) { return path.heading.deg(); },
                          scenario_of("[trajectory]\nheading_deg = 135\n" + keys).trajectory);
    };
    EXPECT_NEAR(heading("kind = \"fixed\"\nat = [1, 2, 3]"), 135, 1e-9);
    EXPECT_NEAR(heading("kind = \"circle\"\ncentre = [1, 2, 3]"), 135, 1e-9);
    EXPECT_NEAR(heading("kind = \"waypoints\"\n[[trajectory.waypoint]]\nat = [1, 2, 3]\n[[trajectory.waypoint]]\n"
                        "at = [1, 2.1, 3]"),
                135, 1e-9);
    EXPECT_THAT(mistakes_of("[trajectory]\nkind = \"fixed\"\nat = [1, 2, 3]\nheading_deg = 400"),
                HasSubstr("trajectory.heading_deg"));
}

TEST(ScenarioReceivers, EachMayRideOnAVehicleOfItsOwn) {
    const Scenario s = scenario_of(
        "[frame]\norigin = [10, 20, 30]\n"
        "[trajectory]\nkind = \"fixed\"\nat = [1, 2, 3]\n"
        "[[receiver]]\n"
        "[[receiver]]\nname = \"boat\"\n[receiver.trajectory]\nkind = \"circle\"\ncentre_level = [0, 0, 0]\n"
        "heading_deg = 90\n"
        "[[receiver]]\n[receiver.trajectory]\nkind = \"waypoints\"\n"
        "[[receiver.trajectory.waypoint]]\nat = [4, 5, 6]\n[[receiver.trajectory.waypoint]]\nat = [4, 5.1, 6]\n"
        "[[receiver]]\n[receiver.trajectory]\nkind = \"file\"\npath = \"way.csv\"\n");
    ASSERT_EQ(s.receivers.size(), 4U);
    EXPECT_FALSE(s.receivers[0].trajectory);
    EXPECT_EQ(&trajectory_of(s, 0), &s.trajectory);
    const auto& circle = std::get<CircleSettings>(trajectory_of(s, 1));
    EXPECT_NEAR(circle.shape.centre.latitude.deg(), 10, 1e-9) << "the level of the one [frame]";
    EXPECT_NEAR(circle.heading.deg(), 90, 1e-9);
    EXPECT_EQ(std::get<WaypointSettings>(trajectory_of(s, 2)).corners.size(), 2U);
    EXPECT_EQ(std::get<FileSettings>(trajectory_of(s, 3)).path, "folder/way.csv");
}

TEST(ScenarioReceivers, MistakesInAnOwnTrajectoryNameItsKey) {
    EXPECT_THAT(mistakes_of("[[receiver]]\n[receiver.trajectory]\nkind = \"fixed\"\n"),
                HasSubstr("test.toml:2:1: [receiver.trajectory] has no place"));
    EXPECT_THAT(mistakes_of("[[receiver]]\n[receiver.trajectory]\nkind = \"circle\"\ncentre = [1, 2, 3]\nradius = 5\n"),
                HasSubstr("receiver.trajectory.radius"));
    EXPECT_THAT(mistakes_of("[[receiver]]\n[receiver.trajectory]\nkind = \"live\"\n"), HasSubstr("has no source"));
    EXPECT_THAT(mistakes_of("[[receiver]]\ntrajectory = 5\n"), HasSubstr("receiver.trajectory"));
}

}  // namespace
}  // namespace skyloop
