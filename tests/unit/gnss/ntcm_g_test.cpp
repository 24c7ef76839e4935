#include "world/gnss/shell_ionosphere.hpp"

#include <gtest/gtest.h>

#include "base/geo/local_frame.hpp"
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
        const Tecu content = ntcm_g_content({row.number("ai0"), row.number("ai1"), row.number("ai2")}, place,
                                            {look.azimuth, look.elevation}, {row.number("doy"), row.number("ut_h")});
        EXPECT_NEAR(content.value(), row.number("stec_tecu"), row.number("tol_tecu"));
    }
}

// Rays that pass over the pole: rows of the test table for high solar activity (NTCM-G Ionospheric Model Description
// 1.0, day 105, receiver at 82.49° N, 62.34° W, 78.11 m). With the longitude of the far side they are 59.6299 and
// 64.1463 TECU.
TEST(NtcmG, TakesLongitudesBeyondThePoleAsPublished) {
    struct Row {
        double hours, longitude, latitude, height, slant;
    };
    const Geodetic place = Geodetic::degrees(82.49, -62.34, 78.11);
    for (const Row& row : {Row{4, 140.68, 35.85, 19953735.00, 54.6962}, Row{12, 81.09, 35.20, 20278071.03, 65.0500}}) {
        const LookAngles look =
            LocalFrame(place).look_angles(to_ecef(Geodetic::degrees(row.latitude, row.longitude, row.height)));
        const Tecu content = ntcm_g_content({236.831641, -0.39362878, 0.00402826613}, place,
                                            {look.azimuth, look.elevation}, {105, row.hours});
        EXPECT_NEAR(content.value(), row.slant, 0.001) << row.hours;
    }
}

TEST(NtcmG, CountsTheDayFromItsCalendar) {
    UtcTime utc;
    utc.year = 2024, utc.month = 3, utc.day = 1, utc.hour = 6, utc.minute = 30;
    EXPECT_EQ(IonosphereTime::of(utc).day_of_year, 61);
    EXPECT_DOUBLE_EQ(IonosphereTime::of(utc).hours, 6.5);
}

// In the zenith.
Tecu content_at_noon(const EffectiveIonisation& broadcast) {
    return ntcm_g_content(broadcast, Geodetic::degrees(46, 30, 0), {Angle::degrees(0), Angle::degrees(90)}, {100, 10});
}

TEST(NtcmG, TakesNeQuicksLevelWhereNoneIsBroadcast) { EXPECT_EQ(content_at_noon({}), content_at_noon({63.7, 0, 0})); }

TEST(NtcmG, GrowsWithTheSun) {
    EXPECT_GT(content_at_noon({190, 0, 0}).value(), 2 * content_at_noon({64, 0, 0}).value());
}

}  // namespace
}  // namespace skyloop
