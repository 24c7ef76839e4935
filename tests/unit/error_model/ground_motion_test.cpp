#include "receiver/error_model/fix_builder.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/oracle_table.hpp"

namespace skyloop {
namespace {

const GpsTime motion_start = to_gps_time(2111, 345600.0);

TimedPosition timed(double seconds, double latitude, double longitude, double height) {
    return {advanced(motion_start, Seconds(seconds)), Geodetic::degrees(latitude, longitude, height)};
}

TEST(MotionBetween, EveryOracleRow) {
    for (const test::OracleRow& row : test::oracle_rows("paper_velocity_heading.csv")) {
        SCOPED_TRACE(row.id());
        const double tolerance = row.number("tol_m_s");
        const GroundMotion motion = motion_between(
            timed(0, row.number("lat1_deg"), row.number("lon1_deg"), row.number("h1_m")),
            timed(row.number("dt_s"), row.number("lat2_deg"), row.number("lon2_deg"), row.number("h2_m")));
        EXPECT_NEAR(motion.velocity.north, row.number("v_north_m_s"), tolerance);
        EXPECT_NEAR(motion.velocity.east, row.number("v_east_m_s"), tolerance);
        EXPECT_NEAR(motion.velocity.down, row.number("v_down_m_s"), tolerance);
        EXPECT_NEAR(motion.speed.value(), row.number("ground_speed_m_s"), tolerance);
        EXPECT_NEAR(std::remainder(motion.course.deg() - row.number("heading_deg"), 360), 0, row.number("tol_deg"));
        EXPECT_GE(motion.course.deg(), 0);
        EXPECT_LT(motion.course.deg(), 360);
    }
}

TEST(MotionBetween, CrossesTheAntimeridianTheShortWay) {
    const GroundMotion motion = motion_between(timed(0, 10, 179.9999, 0), timed(1, 10, -179.9999, 0));
    EXPECT_NEAR(motion.velocity.east, 21.93, 0.01);
    EXPECT_NEAR(motion.course.deg(), 90, 1e-9);
}

// Five metres on either side: there are 111 694 m to a degree of the meridian.
TEST(MotionBetween, CrossesAPoleTheShortWay) {
    constexpr double five_metres = 5 / 111694.0;
    for (const double pole : {90.0, -90.0}) {
        const double latitude = pole - std::copysign(five_metres, pole);
        const GroundMotion motion = motion_between(timed(0, latitude, 10, 100), timed(1, latitude, -170, 100));
        EXPECT_NEAR(motion.speed.value(), 10, 1e-3);
        EXPECT_NEAR(std::remainder(motion.course.deg() - (pole > 0 ? 180 : 0), 360), 0, 1e-6);
    }
}

TEST(MotionBetween, NoTimeNoMotion) {
    const GroundMotion motion = motion_between(timed(5, 10, 20, 0), timed(5, 11, 20, 0));
    EXPECT_EQ(motion.speed.value(), 0);
    EXPECT_EQ(motion.velocity.north, 0);
}

TEST(MotionOfFixes, FirstFixAndFirstAfterAGapReportNoMotion) {
    MotionOfFixes motion;
    EXPECT_EQ(motion.next(timed(0, 46, 30, 0)).speed.value(), 0);
    EXPECT_GT(motion.next(timed(1, 46.0001, 30, 0)).speed.value(), 10);
    motion.interrupt();
    EXPECT_EQ(motion.next(timed(3, 46.0003, 30, 0)).speed.value(), 0);
    EXPECT_GT(motion.next(timed(4, 46.0004, 30, 0)).speed.value(), 10);
}

TEST(GroundMotion, CourseRunsClockwiseFromNorth) {
    EXPECT_NEAR(ground_motion({1, 0, 0}).course.deg(), 0, 1e-12);
    EXPECT_NEAR(ground_motion({0, 1, 0}).course.deg(), 90, 1e-12);
    EXPECT_NEAR(ground_motion({-1, 0, 0}).course.deg(), 180, 1e-12);
    EXPECT_NEAR(ground_motion({0, -1, 0}).course.deg(), 270, 1e-12);
    EXPECT_LT(ground_motion({1, -1e-20, 0}).course.deg(), 360);
}

}  // namespace
}  // namespace skyloop
