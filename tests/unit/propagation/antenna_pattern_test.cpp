#include "world/propagation/antenna_and_noise.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

namespace skyloop {
namespace {

using ::testing::HasSubstr;

double gain_at(const AntennaPattern& pattern, double azimuth, double elevation) {
    return pattern.gain({Angle::degrees(azimuth), Angle::degrees(elevation)}).value();
}

TEST(AntennaPattern, FollowsTheFormula) {
    EXPECT_NEAR(gain_at({}, 0, 90), 3.4, 1e-12);
    EXPECT_NEAR(gain_at({}, 77, 5), 3.4 - 16.5 * std::pow(1 - std::sin(5 * std::numbers::pi / 180), 1.3), 1e-12);
    EXPECT_NEAR(gain_at({Decibels(5), Decibels(10), 1}, 0, 0), -5, 1e-12);
}

TEST(AntennaPattern, ReadsATableByElevation) {
    const auto pattern =
        AntennaPattern::parse("# a patch\nelevation_deg,gain_dbic\n90, 5\r\n0,-6\n30,1\n", "patch.csv");
    ASSERT_TRUE(pattern) << pattern.error().message;
    EXPECT_NEAR(gain_at(*pattern, 200, 60), 3, 1e-12);
    EXPECT_NEAR(gain_at(*pattern, 10, 10), -6 + 7. / 3, 1e-12);
    EXPECT_EQ(gain_at(*pattern, 10, -30), -6);
    const auto marked = AntennaPattern::parse(
        "\xEF\xBB\xBF"
        "elevation_deg,gain_dbic\r\n90,5\r\n0,-6\r\n",
        "patch.csv");
    ASSERT_TRUE(marked) << marked.error().message;
    EXPECT_EQ(gain_at(*marked, 0, 90), 5);
}

TEST(AntennaPattern, IsScaled) {
    const AntennaPattern patch;
    const auto table = AntennaPattern::parse("elevation_deg,gain_dbic\n0,-6\n90,5\n", "patch.csv");
    ASSERT_TRUE(table);
    for (const double elevation : {-20.0, 0.0, 17.0, 90.0})
        for (const double factor : {0.0, 0.5, 1.0, 2.0}) {
            EXPECT_NEAR(gain_at(patch.scaled(factor), 0, elevation), factor * gain_at(patch, 0, elevation), 1e-12);
            EXPECT_NEAR(gain_at(table->scaled(factor), 0, elevation), factor * gain_at(*table, 0, elevation), 1e-12);
        }
}

TEST(AntennaPattern, ReadsATableAroundTheCompass) {
    const auto pattern = AntennaPattern::parse(
        "azimuth_deg,elevation_deg,gain_dbic\n0,0,-4\n0,90,4\n90,0,-8\n90,90,4\n270,0,-6\n270,90,4\n360,0,-4\n",
        "p.csv");
    ASSERT_TRUE(pattern) << pattern.error().message;
    EXPECT_NEAR(gain_at(*pattern, 45, 0), -6, 1e-12);
    EXPECT_NEAR(gain_at(*pattern, 180, 0), -7, 1e-12);
    EXPECT_NEAR(gain_at(*pattern, 315, 0), -5, 1e-12);
    EXPECT_NEAR(gain_at(*pattern, -45, 45), -0.5, 1e-12);
    EXPECT_NEAR(gain_at(*pattern, 123, 90), 4, 1e-12);
}

TEST(AntennaPattern, SaysWhereATableIsWrong) {
    const auto refusal = [](std::string_view text) {
        const auto pattern = AntennaPattern::parse(text, "p.csv");
        return pattern ? std::string("none") : pattern.error().message;
    };
    EXPECT_THAT(refusal("el,gain\n"), HasSubstr("p.csv:1: found \"el,gain\"; expected \"elevation_deg,gain_dbic\""));
    EXPECT_THAT(refusal(""), HasSubstr("found no rows"));
    EXPECT_THAT(refusal("elevation_deg,gain_dbic\n"), HasSubstr("p.csv:1: found no rows"));
    EXPECT_THAT(refusal("elevation_deg,gain_dbic\n10,1\n20,x\n"), HasSubstr("p.csv:3: found \"x\"; expected a number"));
    EXPECT_THAT(refusal("elevation_deg,gain_dbic\n10\n"), HasSubstr("p.csv:2: found 1 columns; expected 2"));
    EXPECT_THAT(refusal("elevation_deg,gain_dbic\n10,1,2\n"), HasSubstr("p.csv:2: found more than 2 columns"));
    EXPECT_THAT(refusal("elevation_deg,gain_dbic\n95,1\n"), HasSubstr("p.csv:2: elevation is 95"));
    EXPECT_THAT(refusal("elevation_deg,gain_dbic\n10,1\n10,2\n"), HasSubstr("p.csv:3: this direction"));
    EXPECT_THAT(refusal("elevation_deg,gain_dbic\n10,inf\n"), HasSubstr("p.csv:2: found \"inf\""));
    EXPECT_THAT(refusal("azimuth_deg,elevation_deg,gain_dbic\n0,0,1\n0,90,2\n90,0,1\n"), HasSubstr("azimuth 90 has"));
    EXPECT_FALSE(AntennaPattern::read("/nonexistent/pattern.csv"));
}

TEST(SatellitePattern, ReadsATableAndRefusesMistakes) {
    const auto points = read_satellite_pattern("# L1\noff_boresight_deg,eirp_dbw\n0,25\n9.5,27.5\n14,24\n", "sat.csv");
    ASSERT_TRUE(points);
    ASSERT_EQ(points->size(), 3U);
    EXPECT_DOUBLE_EQ((*points)[1].off_boresight.deg(), 9.5);
    EXPECT_EQ((*points)[2].eirp.value(), 24);
    const auto refusal = [](std::string_view text) {
        const auto read = read_satellite_pattern(text, "sat.csv");
        return read ? std::string("accepted") : read.error().message;
    };
    EXPECT_EQ(refusal("angle,power\n0,1\n"),
              "sat.csv:1: found \"angle,power\"; expected \"off_boresight_deg,eirp_dbw\"");
    EXPECT_EQ(refusal("off_boresight_deg,eirp_dbw\n5,25\n5,26\n"),
              "sat.csv:3: angle is 5; expected 0 to 90, ascending");
    EXPECT_EQ(refusal("off_boresight_deg,eirp_dbw\n0,x\n"), "sat.csv:2: found \"x\"; expected a number");
    EXPECT_EQ(refusal("off_boresight_deg,eirp_dbw\n"),
              "sat.csv:1: found no rows; expected at least one line of numbers");
}

}  // namespace
}  // namespace skyloop
