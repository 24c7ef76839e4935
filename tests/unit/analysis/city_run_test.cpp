#include "study/analysis/city_run.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace skyloop {
namespace {

using ::testing::HasSubstr;

constexpr std::string_view run_fixes =
    "time_utc,true_lat_deg,true_lon_deg,true_height_m,east_error_m,north_error_m\n"
    "2026-01-01T00:00:00.000Z,46.4,30.7,50,3,4\n"
    "2026-01-01T00:00:01.500Z,46.5,30.8,50,,\n";
constexpr std::string_view run_satellites =
    "time_utc,satellite,elevation_deg,line_of_sight,paths\n"
    "2026-01-01T00:00:00.000Z,G01,40,1,1\n"
    "2026-01-01T00:00:00.000Z,G02,40,0,2\n"
    "2026-01-01T00:00:00.000Z,G03,40,0,0\n"
    "2026-01-01T00:00:00.000Z,G04,4.9,1,1\n"
    "2026-01-01T00:00:01.500Z,G01,40,1,1\n";

TEST(CityRun, counts_what_arrives_at_each_epoch) {
    const auto run = parse_city_run(run_fixes, run_satellites, "run");
    ASSERT_TRUE(run) << run.error().message;
    ASSERT_EQ(run->epochs.size(), 2u);
    EXPECT_EQ(run->start, "2026-01-01T00:00:00.000Z");
    EXPECT_EQ(run->epochs[0].error, Metres(5));
    EXPECT_EQ(run->epochs[0].received, (std::array{1, 0, 1, 1}));
    EXPECT_DOUBLE_EQ(run->epochs[1].since_start.value(), 1.5);
    EXPECT_FALSE(run->epochs[1].error);
    EXPECT_NEAR(run->epochs[1].truth.latitude.deg(), 46.5, 1e-12);
}

TEST(CityRun, counts_states_where_the_table_has_them) {
    const auto run = parse_city_run(run_fixes,
                                    "time_utc,satellite,elevation_deg,line_of_sight,paths,state\n"
                                    "2026-01-01T00:00:00.000Z,G01,40,1,1,shadowed\n",
                                    "run");
    ASSERT_TRUE(run) << run.error().message;
    EXPECT_EQ(run->epochs[0].received, (std::array{0, 1, 0, 0}));
    const auto odd = parse_city_run(run_fixes,
                                    "time_utc,satellite,elevation_deg,line_of_sight,paths,state\n"
                                    "2026-01-01T00:00:00.000Z,G01,40,1,1,dim\n",
                                    "run");
    ASSERT_FALSE(odd);
    EXPECT_EQ(odd.error().message,
              "run/satellites.csv:2: state is 'dim'; expected one of line_of_sight shadowed reflected blocked");
}

TEST(CityRun, refuses_tables_with_file_and_line) {
    const auto message = [](std::string fixes, std::string satellites) {
        return parse_city_run(fixes, satellites, "run").error().message;
    };
    const std::string fixes(run_fixes), satellites(run_satellites);
    EXPECT_THAT(message("", satellites), HasSubstr("run/fixes.csv:1: no column time_utc"));
    EXPECT_THAT(message(fixes, "time_utc\n"), HasSubstr("run/satellites.csv:1: no column elevation_deg"));
    EXPECT_THAT(message(fixes, satellites + "x,1\n"), HasSubstr("run/satellites.csv:7: found 2 cells, expected 5"));
    EXPECT_THAT(message(fixes, satellites + "x,G1,high,1,1\n"), HasSubstr("'high' is not a number"));
    EXPECT_THAT(message(fixes + "2026-01-01T00:00:02Z,91,0,0,,\n", satellites), HasSubstr("run/fixes.csv:4"));
    EXPECT_THAT(message(fixes + "now,0,0,0,,\n", satellites), HasSubstr("run/fixes.csv:4"));
    EXPECT_THAT(message(fixes.substr(0, fixes.find('\n') + 1), satellites), HasSubstr("no epoch"));
}

}  // namespace
}  // namespace skyloop
