#include "skyloop/gnss/ntcm_g.hpp"

#include <gtest/gtest.h>

#include "skyloop/geo/local_frame.hpp"
#include "support/oracle_table.hpp"

namespace skyloop {
namespace {

using test::OracleRow;

TEST(NtcmG, EveryOracleRow) {
    for (const OracleRow& row : test::oracle_rows("iono_ntcm_g.csv")) {
        SCOPED_TRACE(row.id());
        const Geodetic place =
            Geodetic::degrees(row.number("rx_lat_deg"), row.number("rx_lon_deg"), row.number("rx_h_m"));
        const Geodetic satellite =
            Geodetic::degrees(row.number("sat_lat_deg"), row.number("sat_lon_deg"), row.number("sat_h_m"));
        const LookAngles look = LocalFrame(place).look_angles(to_ecef(satellite));
        EXPECT_NEAR(look.elevation.deg(), row.number("el_deg"), 1e-6);
        const NtcmGContent content =
            ntcm_g_content({row.number("ai0"), row.number("ai1"), row.number("ai2")}, place,
                           {look.azimuth, look.elevation}, {row.number("doy"), row.number("ut_h")});
        EXPECT_NEAR(content.vertical.value(), row.number("vtec_tecu"), row.number("tol_tecu"));
        EXPECT_NEAR(content.slant_factor, row.number("mapping"), 1e-7);
        EXPECT_NEAR(content.slant.value(), row.number("stec_tecu"), row.number("tol_tecu"));
    }
}

TEST(NtcmG, CountsTheDayFromItsCalendar) {
    UtcTime utc;
    utc.year = 2024, utc.month = 3, utc.day = 1, utc.hour = 6, utc.minute = 30;
    EXPECT_EQ(IonosphereTime::of(utc).day_of_year, 61);
    EXPECT_DOUBLE_EQ(IonosphereTime::of(utc).hours, 6.5);
}

TEST(NtcmG, TakesNeQuicksLevelWhereNoneIsBroadcast) {
    EXPECT_EQ(ntcm_g_ionisation({}), 63.7);
    EXPECT_DOUBLE_EQ(ntcm_g_ionisation({80, 0, 0}), 80);
    const PiercePoint where{Angle::degrees(46), Angle::degrees(30)};
    const IonosphereTime noon{100, 10};
    EXPECT_EQ(ntcm_g_vertical_content({}, where, noon), ntcm_g_vertical_content({63.7, 0, 0}, where, noon));
}

TEST(NtcmG, GrowsWithTheSun) {
    const PiercePoint where{Angle::degrees(46), Angle::degrees(30)};
    const IonosphereTime noon{100, 10};
    EXPECT_GT(ntcm_g_vertical_content({190, 0, 0}, where, noon).value(),
              2 * ntcm_g_vertical_content({64, 0, 0}, where, noon).value());
}

}  // namespace
}  // namespace skyloop
