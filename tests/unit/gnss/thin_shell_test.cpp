#include "world/gnss/shell_ionosphere.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/oracle_table.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop {
namespace {

TEST(ThinShell, EveryOracleRow) {
    for (const test::OracleRow& row : test::oracle_rows("iono_ionex.csv")) {
        SCOPED_TRACE(row.id());
        const Geodetic place = Geodetic::degrees(row.number("lat_deg"), row.number("lon_deg"), row.number("h_m"));
        const SkyDirection direction{Angle::degrees(row.number("az_deg")), Angle::degrees(row.number("el_deg"))};
        const PiercePoint there = pierce_point({}, place, direction);
        EXPECT_NEAR(there.latitude.deg(), row.number("ipp_lat_deg"), 1e-7);
        EXPECT_NEAR(std::remainder(there.longitude.deg() - row.number("ipp_lon_deg"), 360.0), 0, 1e-7);
        const Metres height = place.height.above_ellipsoid;
        EXPECT_NEAR(single_layer_mapping({}, direction.elevation, height), row.number("mapping_single_layer"), 1e-8);
        EXPECT_NEAR(modified_single_layer_mapping({}, direction.elevation), row.number("mapping_modified"), 1e-8);
    }
}

TEST(ThinShell, ARayOverThePoleComesDownOnTheOtherSide) {
    const PiercePoint there = pierce_point({}, Geodetic::degrees(88, 20, 0), {Angle::degrees(0), Angle::degrees(10)});
    EXPECT_NEAR(there.longitude.deg(), -160, 1e-9);
    EXPECT_LT(there.latitude.deg(), 90);
}

TEST(ThinShell, PublishedCorrectionsLeaveARayOverThePoleOnItsSide) {
    const Geodetic place = Geodetic::degrees(88, 20, 0);
    for (const double azimuth : {0.0, 30.0, 330.0, 180.0}) {
        const SkyDirection direction{Angle::degrees(azimuth), Angle::degrees(10)};
        const PiercePoint there = published_pierce_point({}, place, direction);
        const double psi = pierce_angle({}, direction.elevation).rad();
        const double arcsine =
            std::asin(std::sin(psi) * std::sin(direction.azimuth.rad()) / std::cos(there.latitude.rad()));
        EXPECT_NEAR(there.longitude.deg(), 20 + Angle::radians(arcsine).deg(), 1e-6) << azimuth;
        EXPECT_EQ(there.latitude.rad(), pierce_point({}, place, direction).latitude.rad());
    }
    const SkyDirection slant{Angle::degrees(70), Angle::degrees(20)};
    const Geodetic odessa = Geodetic::degrees(46, 179, 0);
    EXPECT_EQ(published_pierce_point({}, odessa, slant).longitude.rad(),
              pierce_point({}, odessa, slant).longitude.rad());
}

TEST(ThinShell, StraightUpIsTheVertical) {
    const SkyDirection zenith{Angle::degrees(123), Angle::degrees(90)};
    const PiercePoint there = pierce_point({}, Geodetic::degrees(-40, 179, 0), zenith);
    EXPECT_NEAR(there.latitude.deg(), -40, 1e-9);
    EXPECT_NEAR(there.longitude.deg(), 179, 1e-9);
    EXPECT_NEAR(single_layer_mapping({}, zenith.elevation), 1, 1e-12);
    EXPECT_NEAR(modified_single_layer_mapping({}, zenith.elevation), 1, 1e-12);
    EXPECT_NEAR(ionosphere_group_delay(Tecu(1), Hertz(carrier_frequency_l1)).value(), 0.162372, 1e-6);
}

}  // namespace
}  // namespace skyloop
