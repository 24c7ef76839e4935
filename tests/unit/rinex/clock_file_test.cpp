#include "world/rinex/clock_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/time/utc_time.hpp"
#include "support/oracle_table.hpp"
#include "world/rinex/precise_orbit_file.hpp"

namespace skyloop::test {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

const SatelliteId clock_satellite{Constellation::gps, 2};
const GpsTime clock_day = gps_calendar_time(2010, 7, 1, 0, 0, 0);

const std::string clock_header =
    "     3.00           C                                       RINEX VERSION / TYPE\n"
    "                                                            END OF HEADER\n";

std::string clock_line(std::string_view rest) { return "AS " + std::string(rest) + "\n"; }

std::string clock_refusal(const std::string& text) {
    const auto read = read_clocks(text, "made.clk");
    EXPECT_FALSE(read);
    return read ? std::string() : read.error().message;
}

const std::string two_clocks = clock_header + "AR ABPO 2010 07 01 00 00  0.000000  1   -5.778304214828e-08\n" +
                               clock_line("G02  2010 07 01 00 00  0.000000  2    2.0e-04  1.5e-11") +
                               clock_line("G02  2010 07 01 00 05  0.000000  1    2.3e-04");

TEST(ClockFile, ReadsClocksOfSatellitesAndLeavesThoseOfStations) {
    const auto clocks = read_clocks(two_clocks, "made.clk");
    ASSERT_TRUE(clocks) << clocks.error().message;
    EXPECT_EQ(clocks->samples().size(), 1U);
    EXPECT_EQ(clocks->spacing(), 5min);
    const auto middle = clocks->at(clock_satellite, clock_day + 150s);
    ASSERT_TRUE(middle);
    EXPECT_NEAR(middle->bias, 2.15e-4, 1e-16);
    EXPECT_NEAR(middle->drift, 0.3e-4 / 300, 1e-18);
    EXPECT_EQ(clocks->at(clock_satellite, clock_day + 5min)->bias, 2.3e-4);
    EXPECT_FALSE(clocks->at(clock_satellite, clock_day - 1ns));
    EXPECT_NEAR(clocks->at(clock_satellite, clock_day - 1s, 1s)->bias, 2e-4 - 1e-7, 1e-16) << "carried on when asked";
    EXPECT_FALSE(clocks->at({Constellation::gps, 3}, clock_day));
}

TEST(ClockFile, DoesNotReachOverGaps) {
    const auto clocks =
        read_clocks(two_clocks + clock_line("G02  2010 07 01 00 15  0.000000  1    2.9e-04"), "made.clk");
    ASSERT_TRUE(clocks);
    EXPECT_FALSE(clocks->at(clock_satellite, clock_day + 10min));
    EXPECT_EQ(clocks->at(clock_satellite, clock_day + 15min)->bias, 2.9e-4);
}

// Version 3.04 has names of nine letters, and labels five columns further.
TEST(ClockFile, ReadsTheWiderColumnsAndOtherTimes) {
    const auto clocks = read_clocks(
        "3.04                 C                    M                    RINEX VERSION / TYPE\n"
        "   UTC                                                           TIME SYSTEM ID\n"
        "                                                                 END OF HEADER\n" +
            clock_line("G02       2020 06 25 00 00  0.000000  1   2.0e-04") +
            clock_line("G02       2020 06 25 00 00 30.000000  1   2.1e-04"),
        "made.clk");
    ASSERT_TRUE(clocks) << clocks.error().message;
    EXPECT_EQ(clocks->span()->first, gps_calendar_time(2020, 6, 25, 0, 0, 18));
    EXPECT_EQ(clocks->spacing(), 30s);
}

TEST(ClockFile, NamesTheLineThatIsWrong) {
    EXPECT_THAT(clock_refusal("     3.00           N                                       RINEX VERSION / TYPE\n"),
                HasSubstr("made.clk:1: found"));
    EXPECT_THAT(clock_refusal(""), HasSubstr("an empty file; expected a RINEX clock file"));
    EXPECT_THAT(clock_refusal(clock_header), HasSubstr("no two clocks of a satellite"));
    EXPECT_THAT(clock_refusal(clock_header + clock_line("G02 2010 13 01 00 00 0.0 1 2.0e-04")),
                HasSubstr("made.clk:3: found"));
    EXPECT_THAT(clock_refusal(clock_header + clock_line("G02 2010 07 01 00 00 0.0 1 two")),
                HasSubstr("made.clk:3: found 'two'; expected a clock bias"));
    EXPECT_THAT(clock_refusal(two_clocks + clock_line("G02 2010 07 01 00 05 0.0 1 2.0e-04")),
                HasSubstr("made.clk:6: "));
    EXPECT_THAT(clock_refusal(clock_header + "XX what\n"), HasSubstr("made.clk:3: found 'XX what'"));
}

TEST(ClockFile, AgreesWithTheOrbitsOfItsDay) {
    SKYLOOP_REQUIRE_SHARED(folder, "precise");
    const auto clocks = read_clock_file(folder / "igs15904.clk");
    ASSERT_TRUE(clocks) << clocks.error().message;
    EXPECT_EQ(clocks->spacing(), 5min);
    const auto orbits = read_precise_orbit_file(folder / "igs15904.sp3");
    ASSERT_TRUE(orbits);
    int compared = 0;
    for (const auto& [satellite, rows] : orbits->orbits.samples())
        for (const PreciseSample& row : rows)
            if (const auto reading = clocks->at(satellite, row.time); reading && row.clock) {
                EXPECT_NEAR(reading->bias, *row.clock, 1e-12) << to_string(satellite);  // SP3 has a picosecond
                ++compared;
            }
    EXPECT_GT(compared, 100);
}

TEST(PreciseTables, JoinDays) {
    const ClockSample first{clock_day, 1e-4}, second{clock_day + 5min, 2e-4}, third{clock_day + 10min, 3e-4};
    PreciseClocks day({{clock_satellite, {first, second}}}, 5min);
    day.add(PreciseClocks({{clock_satellite, {{clock_day + 5min, 9e-4}, third}}}, 5min));
    EXPECT_EQ(day.at(clock_satellite, clock_day + 5min)->bias, 2e-4) << "the former file's row stays";
    EXPECT_NEAR(day.at(clock_satellite, clock_day + 450s)->bias, 2.5e-4, 1e-16);
    EXPECT_EQ(day.span()->last, clock_day + 10min);
}

}  // namespace
}  // namespace skyloop::test
