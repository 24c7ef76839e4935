#include "world/rinex/ionex_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "support/oracle_table.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop {
namespace {

using test::OracleRow;
using ::testing::HasSubstr;

std::string headed(std::string text, const std::string& label) {
    text.resize(60, ' ');
    return text + label + "\n";
}

std::string ionex_head() {
    return headed("     1.0            IONOSPHERE MAPS     GPS", "IONEX VERSION / TYPE") +
           headed("  6371.0", "BASE RADIUS") + headed("     2", "MAP DIMENSION") +
           headed("   450.0 450.0   0.0", "HGT1 / HGT2 / DHGT") + headed("    40.0  30.0 -10.0", "LAT1 / LAT2 / DLAT") +
           headed("     0.0  20.0  10.0", "LON1 / LON2 / DLON") + headed("    -1", "EXPONENT") +
           headed("", "END OF HEADER");
}

std::string ionex_map(const std::string& epoch, const std::string& values = "   10   20 9999\n") {
    return headed("     1", "START OF TEC MAP") + headed(epoch, "EPOCH OF CURRENT MAP") +
           headed("    40.0   0.0  20.0  10.0 450.0", "LAT/LON1/LON2/DLON/H") + values +
           headed("    30.0   0.0  20.0  10.0 450.0", "LAT/LON1/LON2/DLON/H") + "   30   40   50\n" +
           headed("     1", "END OF TEC MAP");
}

const std::string first_epoch = "  2017     1     1    22     0     0",
                  last_epoch = "  2017     1     1    24     0     0";

std::string whole_ionex() {
    return ionex_head() + ionex_map(first_epoch) + ionex_map(last_epoch) + headed("     1", "START OF RMS MAP") +
           "anything\n" + headed("     1", "END OF RMS MAP") + headed("", "END OF FILE");
}

std::string ionex_error(const std::string& text) {
    const auto maps = read_ionex(text, "a.17i");
    return maps ? "no error" : maps.error().message;
}

TEST(Ionex, EveryOracleRow) {
    SKYLOOP_REQUIRE_SHARED(folder, "oracles/data");
    for (const OracleRow& row : test::oracle_rows("iono_ionex.csv")) {
        SCOPED_TRACE(row.id());
        static const auto maps = read_ionex_file(folder / row.text("file"));
        ASSERT_TRUE(maps) << maps.error().message;
        const Geodetic place = Geodetic::degrees(row.number("lat_deg"), row.number("lon_deg"), row.number("h_m"));
        const SkyDirection direction{Angle::degrees(row.number("az_deg")), Angle::degrees(row.number("el_deg"))};
        const PiercePoint there = pierce_point(maps->shell, place, direction);
        UtcTime day;
        day.year = 2017, day.month = 1, day.day = 1;
        const GpsTime time = advanced(to_gps_time(day, LeapSeconds::announced()), Seconds(row.number("sec_of_day_ut")));
        const auto content = vertical_content(*maps, there, time);
        ASSERT_TRUE(content);
        EXPECT_NEAR(content->value(), row.number("vtec_tecu"), 1e-6);
        const double plain = single_layer_mapping(maps->shell, direction.elevation, place.height.above_ellipsoid);
        const double modified = modified_single_layer_mapping(maps->shell, direction.elevation);
        const Hertz l1(carrier_frequency_l1);
        const double tolerance = row.number("tol_m");
        EXPECT_NEAR(ionosphere_group_delay(*content * plain, l1).value(), row.number("delay_L1_single_layer_m"),
                    tolerance);
        EXPECT_NEAR(ionosphere_group_delay(*content * modified, l1).value(), row.number("delay_L1_modified_m"),
                    tolerance);
    }
}

TEST(Ionex, ReadsAFileOfADay) {
    SKYLOOP_REQUIRE_SHARED(path, "oracles/data/jplg0010.17i");
    const auto maps = read_ionex_file(path);
    ASSERT_TRUE(maps) << maps.error().message;
    EXPECT_EQ(maps->maps.size(), 13u);
    EXPECT_EQ(maps->latitude.count, 71u);
    EXPECT_EQ(maps->longitude.count, 73u);
    EXPECT_EQ(maps->shell.height, Metres(450000));
}

TEST(Ionex, ReadsGridEpochAndValues) {
    const auto maps = read_ionex(whole_ionex(), "a.17i");
    ASSERT_TRUE(maps) << maps.error().message;
    ASSERT_EQ(maps->maps.size(), 2u);
    EXPECT_EQ(utc_text(maps->maps[0].time), "2017-01-01T22:00:00Z");
    EXPECT_EQ(utc_text(maps->maps[1].time), "2017-01-02T00:00:00Z");
    EXPECT_DOUBLE_EQ(maps->maps[0].content_tecu[1], 2.0);
    EXPECT_TRUE(std::isnan(maps->maps[0].content_tecu[2]));
    const auto value = map_content(*maps, maps->maps[0], {Angle::degrees(35), Angle::degrees(5)});
    ASSERT_TRUE(value);
    EXPECT_NEAR(value->value(), 2.5, 1e-12);
}

TEST(Ionex, EndsADayAfterItsLeapSecond) {
    const auto maps = read_ionex(ionex_head() + ionex_map("  2016    12    31    22     0     0") +
                                     ionex_map("  2016    12    31    24     0     0") + headed("", "END OF FILE"),
                                 "a.16i");
    ASSERT_TRUE(maps) << maps.error().message;
    ASSERT_EQ(maps->maps.size(), 2u);
    EXPECT_EQ(utc_text(maps->maps[1].time), "2017-01-01T00:00:00Z");
    EXPECT_EQ(maps->maps[1].time - maps->maps[0].time, std::chrono::seconds(2 * 3600 + 1));
}

TEST(Ionex, SaysWhatIsWrongAndWhere) {
    EXPECT_THAT(ionex_error(""), HasSubstr("a.17i:1: found ''; expected the line IONEX VERSION / TYPE"));
    EXPECT_THAT(ionex_error(ionex_head()), HasSubstr("a.17i:8: found the end of the text; expected END OF FILE"));
    EXPECT_THAT(ionex_error(ionex_head() + headed("", "END OF FILE")), HasSubstr("no TEC map"));
    EXPECT_THAT(ionex_error(ionex_head() + ionex_map(last_epoch) + ionex_map(first_epoch)),
                HasSubstr("a.17i:17: found '2017     1     1    22     0     0'; expected an epoch after"));
    EXPECT_THAT(ionex_error(ionex_head() + ionex_map(first_epoch, "   10  x20   30\n")),
                HasSubstr("a.17i:12: found 'x20'"));
    EXPECT_THAT(ionex_error(ionex_head() + ionex_map("  2017    13     1    22     0     0")), HasSubstr("a.17i:10"));
    EXPECT_THAT(ionex_error(ionex_head() + "noise\n"), HasSubstr("a.17i:9: found 'noise'"));
    std::string text = whole_ionex();
    text.replace(text.find("     2 "), 6, "     3");
    EXPECT_THAT(ionex_error(text), HasSubstr("maps of 2 dimensions"));
    text = whole_ionex();
    text.replace(text.find("    30.0   0.0"), 8, "    20.0");
    EXPECT_THAT(ionex_error(text), HasSubstr("the next parallel of the header's grid"));
}

TEST(Ionex, NoCutCrashesIt) {
    const std::string text = whole_ionex();
    for (std::size_t length = 0; length + 20 < text.size(); ++length)
        EXPECT_FALSE(read_ionex(std::string_view(text).substr(0, length), "cut")) << length;
}

}  // namespace
}  // namespace skyloop
