// Solutions of RTKLIB, and RINEX files that need to be solved first.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/time/utc_time.hpp"
#include "study/analysis/fix_series.hpp"

namespace skyloop {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string program_line = "% program   : RTKLIB ver.2.4.3 b34\n%\n";

std::string solution_error(const std::string& text) {
    const auto series = parse_fix_series(text, "a.pos");
    return series ? "no error" : series.error().message;
}

// What rnx2rtkp writes of one epoch with its options -t, none, -u, -g, -e and -s ,.
TEST(RtklibSolution, all_forms_of_a_row_are_one_fix) {
    const std::string degrees = "latitude(deg) longitude(deg)  height(m)   Q  ns   sdn(m) ratio\n";
    for (const std::string& text :
         {"%  GPST      " + degrees +
              "2018/10/15 17:00:00.000   53.282575524   -8.982468311   118.8172   5  15   3.79  0\n",
          "%  GPST      " + degrees +
              "2023 147600.000   53.282575524   -8.982468311   118.8172   5  15   3.7917 0.0\r\n",
          "%  UTC       " + degrees + "2023 147582.000   53.282575524   -8.982468311   118.8172   5  15   3.7917 0.0\n",
          "%  UTC       " + degrees +
              "2018/10/15 16:59:42.000   53.282575524   -8.982468311   118.8172   5  15   3.7  0\n",
          "%  JST       " + degrees +
              "2018/10/16 01:59:42.000   53.282575524   -8.982468311   118.8172   5  15   3.7  0\n",
          "%  GPST    latitude(d'\")   longitude(d'\")  height(m)   Q  ns\n" +
              std::string("2023 147600.000   53 16 57.2718864   -8 58 56.8859196   118.8172   5  15   3.7917\n"),
          "%  GPST              x-ecef(m)      y-ecef(m)      z-ecef(m)   Q  ns\n" +
              std::string("2023 147600.000   3774721.7335   -596673.2614   5089502.3313   5  15   5.8931\n"),
          "%  GPST        , latitude(deg),longitude(deg), height(m),  Q, ns\n" +
              std::string("2023,147600.000,  53.282575524,  -8.982468311,  118.8172,  5, 15,  3.7917\n")}) {
        const auto series = parse_fix_series(program_line + text, "a.pos");
        ASSERT_TRUE(series) << series.error().message;
        ASSERT_EQ(series->fixes(), 1u) << text;
        const FixSample& fix = series->samples[0];
        EXPECT_NEAR(fix.position.latitude.deg(), 53.282575524, 2e-9) << text;
        EXPECT_NEAR(fix.position.longitude.deg(), -8.982468311, 2e-9) << text;
        EXPECT_NEAR(fix.position.height.above_ellipsoid.value(), 118.8172, 2e-4) << text;
        EXPECT_EQ(fix.time, to_gps_time(2023, 147600.0)) << text;
        EXPECT_EQ(fix.satellites_used, 15);
        EXPECT_TRUE(series->dated && series->warnings.empty());
    }
}

TEST(RtklibSolution, quality_zero_is_no_fix_and_geoid_heights_are_told) {
    const auto series = parse_fix_series(
        "% (lat/lon/height=WGS84/geodetic,Q=1:fix)\n%  GPST  latitude(deg) longitude(deg)  height(m)   Q  ns\n"
        "2023 147600.000 -0.5 1 2 0 3\n2023 147601.000 -0.5 1 2 1 4\n",
        "a.pos");
    ASSERT_TRUE(series) << series.error().message;
    EXPECT_EQ(series->samples.size(), 2u);
    EXPECT_EQ(series->fixes(), 1u);
    EXPECT_EQ(series->interval, Seconds(1));
    EXPECT_THAT(series->warnings, ElementsAre(AllOf(HasSubstr("a.pos"), HasSubstr("above the geoid"))));
    const auto south = parse_fix_series(
        "%  GPST    latitude(d'\")   longitude(d'\")  height(m)   Q  ns\n2023 1.0 -00 30 00.0 001 00 36.0 2 1 4\n",
        "a");
    ASSERT_TRUE(south) << south.error().message;
    EXPECT_NEAR(south->samples[0].position.latitude.deg(), -0.5, 1e-12);
    EXPECT_NEAR(south->samples[0].position.longitude.deg(), 1.01, 1e-12);
}

TEST(RtklibSolution, errors_name_file_line_and_what_was_found) {
    const std::string header = "%  GPST  latitude(deg) longitude(deg)  height(m)   Q  ns\n";
    EXPECT_THAT(solution_error(header), HasSubstr("no fix in 0 rows"));
    EXPECT_THAT(solution_error(header + "2023 147600.000 nan 1 2 5 3\n"),
                AllOf(HasSubstr("a.pos:2:"), HasSubstr("latitude is 'nan'")));
    EXPECT_THAT(solution_error(header + "2023 147600.000 53 1\n"), HasSubstr("height is ''"));
    EXPECT_THAT(solution_error(header + "2023 147600.000 91 1 2 5 3\n"),
                HasSubstr("a.pos:2: latitude is 91; expected -90 to 90"));
    EXPECT_THAT(solution_error(header + "2023 700000.000 1 1 2 5 3\n"), HasSubstr("out of range"));
    EXPECT_EQ(solution_error(header + "11450 1.0 1 1 2 5 3\n"), "no error") << "a day of 2199";
    EXPECT_THAT(solution_error(header + "2018/13/15 17:00:00 1 1 2 5 3\n"), HasSubstr("'2018/13/15 17:00:00'"));
    EXPECT_THAT(solution_error(header + "2023 1.0 1 1 2 77 3\n"), HasSubstr("quality is 77"));
    EXPECT_THAT(solution_error("%  GPST  x-ecef(m) y-ecef(m) z-ecef(m) Q ns\n2023 1.0 1 1 2 5 3\n"),
                HasSubstr("from the Earth's centre"));
    EXPECT_THAT(solution_error("%  GPST  e-baseline(m) n-baseline(m) u-baseline(m) Q ns\n"), HasSubstr("baselines"));
}

TEST(RinexFiles, are_refused_with_the_command_that_solves_them) {
    const std::string end = "RINEX VERSION / TYPE\n";
    EXPECT_THAT(solution_error("     3.04           OBSERVATION DATA    M                   " + end),
                AllOf(HasSubstr("a.pos"), HasSubstr("`skyloop solve a.pos`")));
    EXPECT_THAT(solution_error("3.0                 COMPACT RINEX FORMAT                    CRINEX VERS   / TYPE\n"),
                AllOf(HasSubstr("Hatanaka"), HasSubstr("crx2rnx unpacks it"), HasSubstr("`skyloop solve`"),
                      Not(HasSubstr("solve a.pos"))));
    EXPECT_THAT(solution_error("     3.04           NAVIGATION DATA     M                   " + end),
                AllOf(HasSubstr("type 'N'"), HasSubstr("no fixes")));
}

}  // namespace
}  // namespace skyloop
