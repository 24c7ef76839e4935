#include "base/geo/local_frame.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/core/random.hpp"
#include "support/oracle_table.hpp"

namespace skyloop {
namespace {

using test::OracleRow;

TEST(LocalFrameOracle, EnuAgrees) {
    for (const OracleRow& row : test::oracle_rows("geodesy_enu.csv")) {
        SCOPED_TRACE(row.id());
        const LocalFrame frame(
            Geodetic::degrees(row.number("ref_lat_deg"), row.number("ref_lon_deg"), row.number("ref_h_m")));
        const Eigen::Vector3d enu(row.number("east_m"), row.number("north_m"), row.number("up_m"));
        const Eigen::Vector3d ecef(row.number("x_m"), row.number("y_m"), row.number("z_m"));
        const double tolerance = row.number("tol_m");
        EXPECT_LE((frame.to_ecef(Position<Enu>(enu)).vector() - ecef).norm(), tolerance);
        EXPECT_LE((frame.to_enu(Position<Ecef>(ecef)).vector() - enu).norm(), tolerance);

        const Geodetic place = to_geodetic(frame.to_ecef(Position<Enu>(enu)));
        // Twelve decimals of a degree and six of a metre are written.
        EXPECT_NEAR(place.latitude.deg(), row.number("lat_deg"), 1e-11);
        EXPECT_NEAR(std::remainder(place.longitude.deg() - row.number("lon_deg"), 360.0), 0, 1e-10);
        EXPECT_NEAR(place.height.above_ellipsoid.value(), row.number("h_ell_m"), tolerance);
    }
}

TEST(LocalFrameOracle, HeightOfTheTangentPlaneAgrees) {
    for (const OracleRow& row : test::oracle_rows("geodesy_tangent_plane_height.csv")) {
        const LocalFrame frame(Geodetic::degrees(row.number("ref_lat_deg"), row.number("ref_lon_deg"), 0));
        const double azimuth = Angle::degrees(row.number("azimuth_deg")).rad();
        const double distance = row.number("distance_m");
        const Position<Enu> point(distance * std::sin(azimuth), distance * std::cos(azimuth), 0);
        EXPECT_NEAR(to_geodetic(frame.to_ecef(point)).height.above_ellipsoid.value(),
                    row.number("h_ell_of_plane_point_m"), row.number("tol_m"))
            << row.id();
    }
}

TEST(LocalFrameOracle, LookAnglesAgree) {
    for (const OracleRow& row : test::oracle_rows("geometry_azel_range.csv")) {
        SCOPED_TRACE(row.id());
        const Geodetic receiver =
            Geodetic::degrees(row.number("rx_lat_deg"), row.number("rx_lon_deg"), row.number("rx_h_m"));
        const Eigen::Vector3d place(row.number("rx_x_m"), row.number("rx_y_m"), row.number("rx_z_m"));
        EXPECT_LE((to_ecef(receiver).vector() - place).norm(), row.number("tol_m"));
        const LookAngles look =
            LocalFrame(receiver).look_angles({row.number("sat_x_m"), row.number("sat_y_m"), row.number("sat_z_m")});
        EXPECT_NEAR(std::remainder(look.azimuth.deg() - row.number("az_deg"), 360.0), 0, row.number("tol_deg"));
        EXPECT_NEAR(look.elevation.deg(), row.number("el_deg"), row.number("tol_deg"));
        EXPECT_NEAR(look.range.value(), row.number("r_geom_m"), row.number("tol_m"));
    }
}

TEST(LocalFrame, AxesPointEastNorthAndUp) {
    const LocalFrame frame(Geodetic::degrees(0, 90, 0));  // up is +y, east is −x, north is +z
    EXPECT_LE((frame.to_ecef(Displacement<Enu>(1, 0, 0)).vector() - Eigen::Vector3d(-1, 0, 0)).norm(), 1e-15);
    EXPECT_LE((frame.to_ecef(Displacement<Enu>(0, 1, 0)).vector() - Eigen::Vector3d(0, 0, 1)).norm(), 1e-15);
    EXPECT_LE((frame.to_ecef(Displacement<Enu>(0, 0, 1)).vector() - Eigen::Vector3d(0, 1, 0)).norm(), 1e-15);
}

TEST(LocalFrame, PointsVectorsAndVelocitiesComeBack) {
    RandomStream random(1, "test.local_frame");
    for (int i = 0; i < 5'000; ++i) {
        const LocalFrame frame(Geodetic::degrees(180 * random.uniform() - 90, 360 * random.uniform() - 180, 0));
        const Eigen::Vector3d v(random.normal() * 1e4, random.normal() * 1e4, random.normal() * 1e4);
        ASSERT_LE((frame.to_enu(frame.to_ecef(Position<Enu>(v))).vector() - v).norm(), 1e-8);
        ASSERT_LE((frame.to_enu(frame.to_ecef(Displacement<Enu>(v))).vector() - v).norm(), 1e-9);
        ASSERT_LE((frame.to_enu(frame.to_ecef(Velocity<Enu>(v))).vector() - v).norm(), 1e-9);
        // A rotation keeps lengths.
        ASSERT_NEAR(frame.to_ecef(Velocity<Enu>(v)).vector().norm(), v.norm(), 1e-9);
    }
}

TEST(LocalFrame, StandsAtThePolesAndOnTheDateLine) {
    for (const auto& [latitude, longitude] : {std::pair{90.0, 0.0}, {-90.0, 30.0}, {10.0, 180.0}, {10.0, -180.0}}) {
        const LocalFrame frame(Geodetic::degrees(latitude, longitude, 12));
        const Geodetic above = to_geodetic(frame.to_ecef(Position<Enu>(0, 0, 100)));
        EXPECT_NEAR(above.height.above_ellipsoid.value(), 112, 1e-8);
        EXPECT_NEAR(above.latitude.deg(), latitude, 1e-12);
        // One metre north is one metre further from the equator's side of the axis, also where meridians meet.
        const Eigen::Vector3d north = frame.to_ecef(Displacement<Enu>(0, 1, 0)).vector();
        EXPECT_NEAR(north.z(), std::cos(Angle::degrees(latitude).rad()), 1e-15);
        EXPECT_NEAR(north.norm(), 1, 1e-15);
    }
}

TEST(LookAngles, RunClockwiseFromNorth) {
    const LocalFrame frame(Geodetic::degrees(46.4774, 30.7326, 50));
    const auto look = [&](double east, double north, double up) {
        return frame.look_angles(frame.to_ecef(Position<Enu>(east, north, up)));
    };
    EXPECT_NEAR(look(0, 1000, 0).azimuth.deg(), 0, 1e-9);
    EXPECT_NEAR(look(1000, 0, 0).azimuth.deg(), 90, 1e-9);
    EXPECT_NEAR(look(0, -1000, 0).azimuth.deg(), 180, 1e-9);
    EXPECT_NEAR(look(-1000, 0, 0).azimuth.deg(), 270, 1e-9);
    EXPECT_NEAR(look(1000, 0, 1000).elevation.deg(), 45, 1e-9);
    EXPECT_NEAR(look(0, 1000, -1000).elevation.deg(), -45, 1e-9);
    EXPECT_NEAR(look(0, 0, 1000).elevation.deg(), 90, 1e-5);
    EXPECT_NEAR(look(3000, 4000, 12000).range.value(), 13000, 1e-8);
}

TEST(LookAngles, AzimuthIsNeverAFullTurnNorNegative) {
    const LocalFrame frame(Geodetic::degrees(0, 0, 0));
    const auto azimuth = [&](double east) {
        return frame.look_angles(frame.to_ecef(Position<Enu>(east, 1e6, 0))).azimuth.deg();
    };
    for (const double east : {-1e-300, -1e-12, -1e-9, -1e-6, -0.0, 0.0, 1e-9}) {
        EXPECT_GE(azimuth(east), 0) << east;
        EXPECT_LT(azimuth(east), 360) << east;
        EXPECT_FALSE(std::signbit(azimuth(east))) << east;
    }
    // No direction at all is still a number.
    const LookAngles here = frame.look_angles(frame.to_ecef(Position<Enu>(0, 0, 0)));
    EXPECT_TRUE(std::isfinite(here.azimuth.deg()));
    EXPECT_TRUE(std::isfinite(here.elevation.deg()));
    EXPECT_EQ(here.range.value(), 0);
}

}  // namespace
}  // namespace skyloop
