// Many receivers in one run, each on a vehicle of its own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>

#include "run/emulator/assembly.hpp"
#include "support/run_parts.hpp"
#include "unit/transport/temporary_folder.hpp"

namespace skyloop {
namespace {

using test::emulator_scenario;
using testing::HasSubstr;

constexpr std::size_t fleet_size = 64;
const std::atomic<bool> fleet_never_stops{false};

// Vehicle `i` stands on the equator at i tenths of a degree, or circles there; the last ones have a lever arm.
std::string fleet_text() {
    std::string text =
        "[run]\nstart = 2024-03-05T12:00:00Z\nduration_s = 5\n[model]\nname = \"ideal\"\n"
        "[trajectory]\nkind = \"fixed\"\nat = [60, 0, 100]\n";
    for (std::size_t i = 0; i < fleet_size; ++i) {
        text += fmt::format("[[receiver]]\nport = \"file:wire{}\"\nrate_hz = 2\n", i);
        if (i >= 60) text += "antenna_offset_m = [0, 2, 0]\n";
        if (i == 0) continue;
        text += i % 2 == 0
                    ? fmt::format("[receiver.trajectory]\nkind = \"fixed\"\nat = [0, {}, 100]\n", 0.1 * double(i))
                    : fmt::format(
                          "[receiver.trajectory]\nkind = \"circle\"\ncentre = [0, {}, 100]\nradius_m = "
                          "{}\nspeed_mps = 20\n",
                          0.1 * double(i), 50 + i);
    }
    return text;
}

Assembly fleet_assembly(Scenario scenario, const std::filesystem::path& wires) {
    for (ReceiverEntry& entry : scenario.receivers)
        entry.ports = {"file:" + (wires / entry.ports.at(0).substr(5)).string()};
    RunMode mode;
    mode.virtual_time = true;
    auto assembly = assemble(scenario, test::emulator_data(), mode);
    EXPECT_TRUE(assembly) << assembly.error().message;
    return assembly ? std::move(*assembly) : Assembly{};
}

TEST(Fleet, SixtyFourReceiversHaveSixtyFourWays) {
    const test::TemporaryFolder folder;
    std::filesystem::create_directories(folder / "wires");
    const Scenario scenario = emulator_scenario(fleet_text());
    Assembly assembly = fleet_assembly(scenario, folder / "wires");
    std::map<std::size_t, std::vector<TruthState>> ways;
    assembly.emulator->on_status([&](const Status& s) { ways[s.station].push_back(s.trace->truth); });
    assembly.emulator->run_until(*assembly.end, fleet_never_stops);
    ASSERT_EQ(ways.size(), fleet_size);
    for (std::size_t i = 0; i < fleet_size; ++i) {
        ASSERT_EQ(ways[i].size(), 10U);
        const Geodetic here = i == 0 ? Geodetic::degrees(60, 0, 100) : Geodetic::degrees(0, 0.1 * double(i), 100);
        const double radius = (i % 2 == 1 ? 50.0 + double(i) : 0) + (i >= 60 ? (i % 2 == 1 ? -2 : 2) : 0);
        for (std::size_t k = 0; k < ways[i].size(); ++k) {
            EXPECT_EQ(ways[i][k].time, ways[0][k].time) << "one clock";
            EXPECT_NEAR((ways[i][k].position - to_ecef(here)).length().value(), std::abs(radius), 0.05) << i;
        }
    }
}

TEST(Fleet, EachPortIsCounted) {
    const test::TemporaryFolder folder;
    std::filesystem::create_directories(folder / "wires");
    const Scenario scenario = emulator_scenario(fleet_text());
    Assembly assembly = fleet_assembly(scenario, folder / "wires");
    assembly.emulator->run_until(*assembly.end, fleet_never_stops);
    const auto summary = nlohmann::json::parse(run_summary(scenario, assembly, "1"));
    ASSERT_EQ(summary["receivers"].size(), fleet_size);
    for (std::size_t i = 0; i < fleet_size; ++i) {
        const auto& one = summary["receivers"][i];
        EXPECT_EQ(one["epochs"], 10);
        ASSERT_EQ(one["ports"].size(), 1U);
        const std::string bytes = test::content_of(folder / "wires" / fmt::format("wire{}", i));
        EXPECT_EQ(one["ports"][0]["bytes_out"], bytes.size());
        EXPECT_GT(bytes.size(), 500U);
    }
    EXPECT_FALSE(summary.contains("real_time")) << "virtual time has no deadlines";
}

TEST(Fleet, WhatTheSystemGrantedIsKept) {
    const Scenario scenario = emulator_scenario("[run]\nstart = 2024-03-05T12:00:00Z\n[model]\nname = \"ideal\"\n");
    RunMode mode;
    mode.virtual_time = true;
    mode.open_ports = false;
    auto assembly = assemble(scenario, test::emulator_data(), mode);
    ASSERT_TRUE(assembly) << assembly.error().message;
    assembly->deadlines = DeadlineGrants{ThreadPriority::raised, true, 1, {"what is missing"}};
    const auto summary = nlohmann::json::parse(run_summary(scenario, *assembly, "1"));
    EXPECT_EQ(summary["real_time"],
              nlohmann::json::parse(R"({"priority":"raised","memory_locked":true,"timer_slack_ns":1,)"
                                    R"("missing":["what is missing"]})"));
}

const std::string own_track =
    "[run]\nstart = 2024-03-05T12:00:00Z\nduration_s = 5\n[model]\nname = \"ideal\"\n[[receiver]]\n"
    "[[receiver]]\nname = \"drone\"\n[receiver.trajectory]\nkind = \"file\"\npath = \"";

TEST(Fleet, ATrackOfOneReceiverIsLoadedAndPartOfTheDigest) {
    const test::TemporaryFolder folder;
    const auto digest = [&](const std::string& last_longitude) {
        std::ofstream(folder / "way.csv")
            << "t_s,lat_deg,lon_deg,height_m\n0,10,20,100\n4,10," << last_longitude << ",100\n";
        RunMode mode;
        mode.virtual_time = true;
        mode.open_ports = false;
        auto assembly = assemble(emulator_scenario(own_track + (folder / "way.csv").string() + "\"\n"),
                                 test::emulator_data(), mode);
        EXPECT_TRUE(assembly) << assembly.error().message;
        if (!assembly) return std::string();
        EXPECT_THAT(assembly->trajectory, HasSubstr("receiver 'drone': "));
        assembly->emulator->run_until(*assembly->end, fleet_never_stops);
        const auto& stations = assembly->emulator->stations();
        const GpsTime end = assembly->start + std::chrono::seconds(4);
        EXPECT_NEAR(stations[1].simulation().truth_at(end).geodetic.longitude.deg(), std::stod(last_longitude), 1e-9);
        EXPECT_NEAR(stations[0].simulation().truth_at(end).geodetic.latitude.deg(), 46.4774, 1e-9) << "stays";
        return assembly->digest;
    };
    EXPECT_NE(digest("20.0001"), digest("20.0002"));
    EXPECT_EQ(digest("20.0001"), digest("20.0001"));
}

TEST(Fleet, ATrackThatIsNotThereNamesItsReceiver) {
    const auto refused = assemble(emulator_scenario(own_track + "/no/such/way.csv\"\n"), test::emulator_data(), {});
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message, testing::StartsWith("receiver 'drone': "));
    EXPECT_THAT(refused.error().message, HasSubstr("/no/such/way.csv"));
}

}  // namespace
}  // namespace skyloop
