// HIL_GPS: units, what is unknown, and the limits of its fields.
#include "run/output/epoch_messages.hpp"

#include <gtest/gtest.h>

#include "epochs.hpp"

namespace skyloop {
namespace {

using test::SampleEpoch;

TEST(HilGps, TellsTheSolutionInItsUnits) {
    const MavlinkHilGps m = mavlink_hil_gps(SampleEpoch().state, HilGpsAccuracy::px4_cm);
    EXPECT_EQ(m.time_usec, 1709640000000000U);
    EXPECT_NEAR(m.lat, 470000180, 1);
    EXPECT_EQ(m.lon, 80000000);
    EXPECT_EQ(m.alt, 452000);  // above the sea
    EXPECT_EQ(m.eph, 125);
    EXPECT_EQ(m.epv, 250);
    EXPECT_EQ(m.vel, 1204);
    EXPECT_EQ(m.vn, 1200);
    EXPECT_EQ(m.ve, 100);
    EXPECT_EQ(m.vd, 50);
    EXPECT_EQ(m.cog, 476);
    EXPECT_EQ(m.fix_type, 3);
    EXPECT_EQ(m.satellites_visible, 1);
    EXPECT_EQ(m.yaw, 0);
    const MavlinkHilGps dops = mavlink_hil_gps(SampleEpoch().state, HilGpsAccuracy::dop100);
    EXPECT_EQ(dops.eph, 80);
    EXPECT_EQ(dops.epv, 100);
}

TEST(HilGps, StaysWithinItsFields) {
    SampleEpoch epoch;
    Fix& fix = epoch.state.epoch.fix;
    fix.type = FixType::rtk_fixed;
    fix.speed = MetresPerSecond(7500);
    fix.velocity = {7500, -7500, 400};
    fix.horizontal_accuracy = Metres(5000);
    fix.dop = {};
    epoch.state.course = Angle::degrees(359.999);
    const MavlinkHilGps m = mavlink_hil_gps(epoch.state, HilGpsAccuracy::px4_cm);
    EXPECT_EQ(m.fix_type, 3);
    EXPECT_EQ(m.vel, 65534);
    EXPECT_EQ(m.vn, 32767);
    EXPECT_EQ(m.ve, -32768);
    EXPECT_EQ(m.vd, 32767);
    EXPECT_EQ(m.eph, 65534);
    EXPECT_EQ(m.cog, 0);
    EXPECT_EQ(mavlink_hil_gps(epoch.state, HilGpsAccuracy::dop100).eph, 65535) << "it is not known";
}

TEST(HilGps, WithoutAFixSaysThatNothingIsKnown) {
    SampleEpoch epoch;
    epoch.state.epoch.fix.type = FixType::none;
    const MavlinkHilGps m = mavlink_hil_gps(epoch.state, HilGpsAccuracy::px4_cm);
    EXPECT_EQ(m.fix_type, 1);
    EXPECT_EQ(m.time_usec, 1709640000000000U);
    EXPECT_EQ(m.lat, 0);
    EXPECT_EQ(m.eph, 65535);
    EXPECT_EQ(m.vel, 65535);
    EXPECT_EQ(m.cog, 65535);
}

TEST(HilGps, WithoutAFixTheLastPositionStays) {
    SampleEpoch epoch;
    const MavlinkHilGps before = mavlink_hil_gps(epoch.state, HilGpsAccuracy::px4_cm);
    epoch.state.epoch.fix.type = FixType::none;
    epoch.state.position_known = true;
    const MavlinkHilGps m = mavlink_hil_gps(epoch.state, HilGpsAccuracy::px4_cm);
    EXPECT_EQ(m.fix_type, 1);
    EXPECT_EQ(m.lat, before.lat);
    EXPECT_EQ(m.lon, before.lon);
    EXPECT_EQ(m.alt, before.alt);
    EXPECT_NEAR(m.lat, 470000180, 1);
    EXPECT_EQ(m.eph, 65535);
}

}  // namespace
}  // namespace skyloop
