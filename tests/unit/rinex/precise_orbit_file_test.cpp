#include "world/rinex/precise_orbit_file.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/time/utc_time.hpp"
#include "support/oracle_table.hpp"
#include "world/gnss/navigation_data.hpp"
#include "world/gnss/orbit.hpp"

namespace skyloop::test {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::StartsWith;

const GpsTime table_start = gps_calendar_time(2024, 3, 5, 0, 0, 0);
const SatelliteId table_satellite{Constellation::gps, 3};

std::string epoch_line(GpsTime time) {
    const UtcTime t = gps_calendar(time);
    return fmt::format("*  {:4} {:2} {:2} {:2} {:2} {:11.8f}\n", t.year, t.month, t.day, t.hour, t.minute,
                       t.second + t.nanosecond * 1e-9);
}

// Rows every 15 min of a smooth orbit, to the millimetre as the format has it.
std::string table_text(int epochs, std::string_view time_system = "GPS", std::string_view id = "G03") {
    std::string text = "#cP2024  3  5  0  0  0.00000000      96 ORBIT IGS20 HLM  IGS\n";
    text += "## 2304 172800.00000000   900.00000000 60374 0.0000000000000\n+    1   G03\n";
    text += fmt::format("%c G  cc {} ccc cccc\n%c cc cc ccc ccc cccc\n/* a comment\n", time_system);
    const NominalConstellation nominal;
    for (int i = 0; i < epochs; ++i) {
        const GpsTime t = table_start + i * 15min;
        const Eigen::Vector3d p =
            satellite_state(*nominal.record(table_satellite, table_start), t).position.vector() / 1000;
        text += epoch_line(t);
        text += fmt::format("P{}{:14.6f}{:14.6f}{:14.6f}{:14.6f}\n", id, p.x(), p.y(), p.z(), 100 + 0.5 * i);
    }
    return text + "EOF\n";
}

PreciseOrbitFile precise(const std::string& text) {
    auto file = read_precise_orbits(text, "made.sp3");
    EXPECT_TRUE(file) << file.error().message;
    return file ? std::move(*file) : PreciseOrbitFile{PreciseOrbits({}, 0ns)};
}

std::string precise_refusal(const std::string& text) {
    const auto file = read_precise_orbits(text, "made.sp3");
    EXPECT_FALSE(file);
    return file ? std::string() : file.error().message;
}

std::string swapped(std::string text, std::string_view from, std::string_view to) {
    return text.replace(text.find(from), from.size(), to);
}

TEST(PreciseOrbitFile, ReadsPositionsAndClocks) {
    const PreciseOrbitFile file = precise(table_text(20));
    EXPECT_EQ(file.version, 'c');
    EXPECT_EQ(file.epochs, 20);
    EXPECT_EQ(file.positions, 20);
    EXPECT_EQ(file.orbits.spacing(), 15min);
    const auto& rows = file.orbits.samples().at(table_satellite);
    EXPECT_EQ(rows.front().time, table_start);
    EXPECT_DOUBLE_EQ(*rows.at(2).clock, 101e-6);
}

TEST(PreciseOrbits, PassesThroughItsRowsAndFollowsTheOrbitBetween) {
    const PreciseOrbitFile file = precise(table_text(24));
    const KeplerEphemeris orbit = *NominalConstellation().record(table_satellite, table_start);
    for (int minute = 0; minute <= 23 * 15; minute += 5) {
        const GpsTime t = table_start + minute * 1min;
        const auto state = file.orbits.state(table_satellite, t);
        ASSERT_TRUE(state) << minute;
        const SatelliteState exact = satellite_state(orbit, t);
        // Eleven points hold within millimetres in the middle of a table and within decimetres at its ends.
        const bool middle = minute >= 75 && minute <= 18 * 15;
        EXPECT_LT((state->position - exact.position).length().value(), middle ? 2e-3 : 0.2) << minute;
        EXPECT_LT((state->velocity.vector() - exact.velocity.vector()).norm(), middle ? 1e-5 : 2e-3) << minute;
        EXPECT_NEAR(*state->clock_bias, (100 + 0.5 * minute / 15) * 1e-6, 1e-15);
    }
    EXPECT_FALSE(file.orbits.state(table_satellite, table_start - 1ns));
    EXPECT_FALSE(file.orbits.state(table_satellite, table_start + 23 * 15min + 1ns));
    EXPECT_FALSE(file.orbits.state({Constellation::gps, 4}, table_start));
    EXPECT_FALSE(precise(table_text(10)).orbits.state(table_satellite, table_start)) << "too few rows";
}

TEST(PreciseOrbits, DoesNotReachOverGaps) {
    std::string text = table_text(30);
    // Row 12 loses its position, row 20 its clock.
    const std::string row = epoch_line(table_start + 12 * 15min);
    const std::size_t at = text.find(row) + row.size() + 4;
    text.replace(at, 42, "      0.000000      0.000000      0.000000");
    const std::string clock = fmt::format("{:14.6f}", 100 + 0.5 * 20);
    text.replace(text.find(clock), clock.size(), " 999999.999999");
    const PreciseOrbitFile file = precise(text);
    EXPECT_EQ(file.without_position, 1);
    EXPECT_EQ(file.positions, 29);
    EXPECT_TRUE(file.orbits.state(table_satellite, table_start + 1h));
    EXPECT_FALSE(file.orbits.state(table_satellite, table_start + 12 * 15min));
    const auto later = file.orbits.state(table_satellite, table_start + 20 * 15min);
    ASSERT_TRUE(later);
    EXPECT_FALSE(later->clock_bias);
    EXPECT_FALSE(file.orbits.state(table_satellite, table_start + 19 * 15min + 1min)->clock_bias);
    EXPECT_TRUE(file.orbits.state(table_satellite, table_start + 21 * 15min)->clock_bias);
}

TEST(PreciseOrbitFile, TurnsTimesIntoGpst) {
    const auto first = [](std::string_view system) {
        return precise(table_text(2, system)).orbits.samples().at(table_satellite).front().time;
    };
    EXPECT_EQ(first("GAL"), table_start);
    EXPECT_EQ(first("ccc"), table_start);
    EXPECT_EQ(first("UTC"), table_start + 18s);
    EXPECT_EQ(first("TAI"), table_start - 19s);
    EXPECT_EQ(first("BDT"), table_start + 14s);
    EXPECT_TRUE(precise(table_text(2, "GPS", "  3")).orbits.samples().contains(table_satellite)) << "SP3-a";
    EXPECT_EQ(precise(table_text(3) + "").other_vehicles, 0);
    EXPECT_EQ(precise(swapped(table_text(3), "PG03", "PL52")).other_vehicles, 1);
}

TEST(PreciseOrbitFile, NamesTheLineThatIsWrong) {
    const std::string good = table_text(3);
    EXPECT_THAT(precise_refusal(""), StartsWith("made.sp3:1: found an empty file; expected an SP3 file"));
    EXPECT_THAT(precise_refusal("     2.11           N: GPS NAV DATA\n"), HasSubstr("expected an SP3 file"));
    EXPECT_THAT(precise_refusal(table_text(1)), HasSubstr("found 1 epochs; expected at least two"));
    EXPECT_THAT(precise_refusal(table_text(3, "XYZ")), StartsWith("made.sp3:4: found time system 'XYZ'"));
    EXPECT_THAT(precise_refusal(swapped(good, "*  2024  3  5  0 15", "*  2024  3  5  0  0")),
                StartsWith("made.sp3:9: found '*  2024"));
    EXPECT_THAT(precise_refusal(swapped(good, "*  2024  3  5  0 15", "*  2024 13  5  0 15")),
                HasSubstr("expected an epoch from 1980 to 2269"));
    EXPECT_THAT(precise_refusal(swapped(good, "    100.000000", "    1oo.000000")),
                HasSubstr("made.sp3:8:47: found '1oo.000000'; expected microseconds"));
    EXPECT_THAT(precise_refusal(swapped(good, "EOF", "PG03 1e9")), HasSubstr("expected kilometres, up to 1e6"));
    EXPECT_THAT(precise_refusal(swapped(good, "/* a comment", "what")), HasSubstr("expected a line of SP3"));
}

TEST(PreciseOrbitFile, ReadsTheRealOnes) {
    SKYLOOP_REQUIRE_SHARED(folder, "precise");
    struct Expected {
        const char* name;
        char version;
        int epochs;
        std::size_t satellites;
    };
    for (const Expected& e : {Expected{"igs15904.sp3", 'c', 96, 32}, Expected{"esa15253.sp3", 'c', 96, 48},
                              Expected{"GRG0MGXFIN_20201770000_01D_15M_ORB.SP3.gz", 'c', 96, 75},
                              Expected{"COD0MGXFIN_20230010000_01D_05M_ORB.SP3.gz", 'd', 289, 116}}) {
        const auto file = read_precise_orbit_file(folder / e.name);
        ASSERT_TRUE(file) << file.error().message;
        EXPECT_EQ(file->version, e.version) << e.name;
        EXPECT_EQ(file->epochs, e.epochs) << e.name;
        EXPECT_EQ(file->orbits.samples().size(), e.satellites) << e.name;
        EXPECT_EQ(file->time_system, "GPS");
    }
    const auto clocks = read_precise_orbit_file(folder / "igs15904.clk");
    ASSERT_FALSE(clocks);
    EXPECT_THAT(clocks.error().message, HasSubstr("igs15904.clk:1: found"));
}

}  // namespace
}  // namespace skyloop::test
