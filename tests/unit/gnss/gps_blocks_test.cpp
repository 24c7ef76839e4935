#include "world/gnss/signal.hpp"

#include <gtest/gtest.h>

#include "base/time/utc_time.hpp"

namespace skyloop::test {
namespace {

int satellites_with(Signal signal, GpsTime when) {
    int count = 0;
    for (int prn = 1; prn <= 32; ++prn)
        count += gps_sends(prn, signal, when) ? 1 : 0;
    return count;
}

TEST(GpsBlocks, AreAsManyAsWereInOrbit) {
    const struct {
        GpsTime when;
        int l2c, l5;
    } expected[] = {
        {gps_calendar_time(2005, 1, 1, 0, 0, 0), 0, 0},   {gps_calendar_time(2010, 1, 1, 0, 0, 0), 8, 0},
        {gps_calendar_time(2012, 1, 1, 0, 0, 0), 9, 2},   {gps_calendar_time(2017, 1, 1, 0, 0, 0), 19, 12},
        {gps_calendar_time(2024, 1, 1, 0, 0, 0), 25, 18},  // seven of Block IIR-M, twelve IIF, six III
        {gps_calendar_time(2024, 6, 1, 0, 0, 0), 25, 17},  // SVN 49 in place of SVN 63
        {gps_calendar_time(2026, 1, 1, 0, 0, 0), 26, 19},
    };
    for (const auto& [when, l2c, l5] : expected) {
        EXPECT_EQ(satellites_with(Signal::l1, when), 32);
        EXPECT_EQ(satellites_with(Signal::l2, when), l2c) << week_and_tow(when).week;
        EXPECT_EQ(satellites_with(Signal::l5, when), l5) << week_and_tow(when).week;
    }
}

TEST(GpsBlocks, ChangeWithTheSatelliteOfAPrn) {
    const GpsTime launch = gps_calendar_time(2021, 6, 17, 0, 0, 0);
    EXPECT_FALSE(gps_sends(11, Signal::l2, launch - Nanoseconds(1)));
    EXPECT_TRUE(gps_sends(11, Signal::l2, launch));
    EXPECT_TRUE(gps_sends(11, Signal::l5, launch));
    for (const int prn : {2, 13, 16, 19, 20, 22}) {  // Block IIR
        EXPECT_FALSE(gps_sends(prn, Signal::l2, launch)) << prn;
        EXPECT_FALSE(gps_sends(prn, Signal::l5, launch)) << prn;
    }
    for (const int prn : {5, 7, 12, 15, 17, 29, 31}) {  // Block IIR-M
        EXPECT_TRUE(gps_sends(prn, Signal::l2, launch)) << prn;
        EXPECT_FALSE(gps_sends(prn, Signal::l5, launch)) << prn;
    }
}

TEST(GpsBlocks, SendEverythingUnderPrnsThatNoneHasYet) {
    EXPECT_TRUE(gps_sends(33, Signal::l5, GpsTime{}));
    EXPECT_TRUE(gps_sends(63, Signal::l2, GpsTime{}));
    EXPECT_FALSE(gps_sends(32, Signal::l2, GpsTime{}));
    EXPECT_FALSE(gps_sends(1, Signal::l2, GpsTime{}));
}

}  // namespace
}  // namespace skyloop::test
