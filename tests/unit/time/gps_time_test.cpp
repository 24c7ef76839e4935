#include "base/time/gps_time.hpp"

#include <gtest/gtest.h>

#include "base/core/random.hpp"
#include "support/oracle_table.hpp"

namespace skyloop {
namespace {

using namespace std::chrono_literals;

TEST(WeekAndTow, CountsWholeWeeks) {
    EXPECT_EQ(week_and_tow(GpsTime(0ns)), (WeekAndTow{0, 0ns}));
    EXPECT_EQ(week_and_tow(GpsTime(604'799'999'999'999ns)), (WeekAndTow{0, 604'799'999'999'999ns}));
    EXPECT_EQ(week_and_tow(GpsTime(604'800s)), (WeekAndTow{1, 0ns}));
    EXPECT_EQ(week_and_tow(GpsTime(-1ns)), (WeekAndTow{-1, 604'799'999'999'999ns}));
    EXPECT_EQ(week_and_tow(GpsTime(-604'800s)), (WeekAndTow{-1, 0ns}));
}

TEST(WeekAndTow, IsNotReducedAtRollovers) {
    EXPECT_EQ(week_and_tow(to_gps_time(1024, 0.0)).week, 1024);
    EXPECT_EQ(week_and_tow(to_gps_time(2048, 0.0)).week, 2048);
    EXPECT_EQ(week_and_tow(to_gps_time(8192, 12.5)), (WeekAndTow{8192, 12'500'000'000ns}));
}

TEST(ToGpsTime, CarriesATimeOutsideTheWeek) {
    EXPECT_EQ(to_gps_time(100, 604'800.0), to_gps_time(101, 0.0));
    EXPECT_EQ(to_gps_time(100, -0.25), to_gps_time(99, 604'799.75));
    EXPECT_EQ(to_gps_time(WeekAndTow{100, 5s}), to_gps_time(100, 5.0));
}

TEST(ToGpsTime, RoundsToTheNearestNanosecond) {
    EXPECT_EQ(to_gps_time(0, 1e-9), GpsTime(1ns));
    EXPECT_EQ(to_gps_time(0, 0.4e-9), GpsTime(0ns));
    EXPECT_EQ(to_gps_time(0, -0.6e-9), GpsTime(-1ns));
    EXPECT_EQ(to_gps_time(0, 604'799.999'999'999), GpsTime(604'799'999'999'999ns));
}

TEST(ToNanoseconds, KeepsNanosecondsInALongSpan) {
    EXPECT_EQ(to_nanoseconds(Seconds(1.5e6)), 1'500'000'000'000'000ns);
    EXPECT_EQ(to_nanoseconds(Seconds(-0.5)), -500'000'000ns);
    EXPECT_EQ(advanced(GpsTime(10s), Seconds(-0.000'000'001)), GpsTime(9'999'999'999ns));
}

TEST(Difference, IsInSeconds) {
    EXPECT_DOUBLE_EQ(difference(GpsTime(3s), GpsTime(500ms)).value(), 2.5);
    EXPECT_DOUBLE_EQ(difference(GpsTime(500ms), GpsTime(3s)).value(), -2.5);
}

TEST(WeekAndTow, ComesBackUnchanged) {
    RandomStream random(1, "test.week_and_tow");
    for (int i = 0; i < 10'000; ++i) {
        const GpsTime time(Nanoseconds(static_cast<std::int64_t>(random.bits() >> 1) - (std::int64_t{1} << 62)));
        const WeekAndTow value = week_and_tow(time);
        ASSERT_GE(value.tow, 0ns);
        ASSERT_LT(value.tow, 604'800s);
        ASSERT_EQ(to_gps_time(value), time);
    }
}

TEST(ResolveWeek, AgreesWithTheOracle) {
    for (const test::OracleRow& row : test::oracle_rows("time_week_resolution.csv"))
        EXPECT_EQ(resolve_week(row.integer("week10"), row.integer("pivot_week")), row.integer("full_week")) << row.id();
}

TEST(ResolveWeek, IsTheNearestWeekThatEndsInTheseBits) {
    RandomStream random(1, "test.resolve_week");
    for (int i = 0; i < 10'000; ++i) {
        const auto pivot = static_cast<std::int64_t>(random.uniform() * 8000);
        const auto week10 = static_cast<std::int64_t>(random.uniform() * 1024);
        const std::int64_t week = resolve_week(week10, pivot);
        ASSERT_EQ((week - week10) % 1024, 0);
        ASSERT_LE(std::abs(week - pivot), 512);
    }
}

TEST(OtherSystems, StartWithTheirOwnWeekZero) {
    // BDT starts at 2006-01-01 00:00:00 UTC (BDS-SIS-ICD, 3.3), GST at 13 s before 1999-08-22 00:00:00 UTC (OS SIS ICD,
    // 5.1.2).
    EXPECT_EQ(bdt_week_and_tow(to_gps_time(1356, 14.0)), (WeekAndTow{0, 0ns}));
    EXPECT_EQ(bdt_week_and_tow(to_gps_time(1356, 13.0)), (WeekAndTow{-1, 604'799s}));
    EXPECT_EQ(gst_week_and_tow(to_gps_time(1024, 0.0)), (WeekAndTow{0, 0ns}));
}

}  // namespace
}  // namespace skyloop
