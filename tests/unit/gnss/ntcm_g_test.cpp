#include "world/gnss/shell_ionosphere.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/geo/local_frame.hpp"
#include "support/oracle_table.hpp"

namespace skyloop {
namespace {

using test::OracleRow;

// A row of a table: a receiver, a satellite, the coefficients and the time.
struct NtcmCase {
    Geodetic ground;  // at which the model takes every receiver
    SkyDirection direction;
    EffectiveIonisation level;
    IonosphereTime when;

    explicit NtcmCase(const OracleRow& row) {
        const Geodetic place =
            Geodetic::degrees(row.number("rx_lat_deg"), row.number("rx_lon_deg"), row.number("rx_h_m"));
        const Geodetic satellite =
            Geodetic::degrees(row.number("sat_lat_deg"), row.number("sat_lon_deg"), row.number("sat_h_m"));
        const LookAngles look = LocalFrame(place).look_angles(to_ecef(satellite));
        ground = {place.latitude, place.longitude, {}};
        direction = {look.azimuth, look.elevation};
        level = {row.number("ai0"), row.number("ai1"), row.number("ai2")};
        when = {row.number("doy"), row.number("ut_h")};
    }
    [[nodiscard]] double content(const PiercePoint& pierce) const {
        return ntcm_g_content(level, pierce, direction.elevation, when).value();
    }
    [[nodiscard]] double published() const { return content(published_pierce_point({}, ground, direction)); }
    [[nodiscard]] double exact() const { return content(pierce_point({}, ground, direction)); }
};

TEST(NtcmG, EveryOracleRow) {
    for (const OracleRow& row : test::oracle_rows("iono_ntcm_g.csv")) {
        SCOPED_TRACE(row.id());
        const NtcmCase ray(row);
        EXPECT_NEAR(ray.direction.elevation.deg(), row.number("el_deg"), 1e-6);
        EXPECT_NEAR(ray.published(), row.number("stec_tecu"), row.number("tol_tecu"));
    }
}

// From 82.49° N, where two of the rays pass over the pole.
TEST(NtcmG, TakesLongitudesBeyondThePoleAsPublished) {
    int over_the_pole = 0;
    for (const OracleRow& row : test::oracle_rows("iono_ntcm_g_polar.csv")) {
        SCOPED_TRACE(row.id());
        const NtcmCase ray(row);
        EXPECT_NEAR(ray.published(), row.number("stec_tecu"), row.number("tol_tecu"));
        EXPECT_NEAR(ray.exact(), row.number("stec_exact_tecu"), row.number("tol_tecu"));
        over_the_pole += std::abs(ray.published() - ray.exact()) > 0.5 ? 1 : 0;
    }
    EXPECT_EQ(over_the_pole, 2);
}

TEST(NtcmG, CountsTheDayFromItsCalendar) {
    UtcTime utc;
    utc.year = 2024, utc.month = 3, utc.day = 1, utc.hour = 6, utc.minute = 30;
    EXPECT_EQ(IonosphereTime::of(utc).day_of_year, 61);
    EXPECT_DOUBLE_EQ(IonosphereTime::of(utc).hours, 6.5);
}

// In the zenith.
Tecu content_at_noon(const EffectiveIonisation& broadcast) {
    return ntcm_g_content(broadcast, {Angle::degrees(46), Angle::degrees(30)}, Angle::degrees(90), {100, 10});
}

TEST(NtcmG, TakesNeQuicksLevelWhereNoneIsBroadcast) { EXPECT_EQ(content_at_noon({}), content_at_noon({63.7, 0, 0})); }

TEST(NtcmG, GrowsWithTheSun) {
    EXPECT_GT(content_at_noon({190, 0, 0}).value(), 2 * content_at_noon({64, 0, 0}).value());
}

}  // namespace
}  // namespace skyloop
