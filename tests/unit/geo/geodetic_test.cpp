#include "base/geo/geodetic.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>
#include <sstream>

#include "base/core/random.hpp"
#include "support/oracle_table.hpp"

namespace skyloop {
namespace {

using test::OracleRow;

// The difference of two longitudes, the short way round, degrees.
double longitude_apart(double a, double b) { return std::remainder(a - b, 360.0); }

TEST(GeodeticOracle, ToEcefAgrees) {
    for (const OracleRow& row : test::oracle_rows("geodesy_lla_to_ecef.csv")) {
        const Geodetic place = Geodetic::degrees(row.number("lat_deg"), row.number("lon_deg"), row.number("h_ell_m"));
        const Eigen::Vector3d expected(row.number("x_m"), row.number("y_m"), row.number("z_m"));
        EXPECT_LE((to_ecef(place).vector() - expected).norm(), row.number("tol_m")) << row.id();
    }
}

TEST(GeodeticOracle, ToGeodeticAgrees) {
    for (const OracleRow& row : test::oracle_rows("geodesy_ecef_to_lla.csv")) {
        SCOPED_TRACE(row.id());
        const Geodetic place = to_geodetic({row.number("x_m"), row.number("y_m"), row.number("z_m")});
        EXPECT_NEAR(place.latitude.deg(), row.number("lat_deg"), row.number("tol_deg"));
        EXPECT_NEAR(place.height.above_ellipsoid.value(), row.number("h_ell_m"), row.number("tol_m"));
        // The longitude at a pole is arbitrary.
        if (std::abs(row.number("lat_deg")) < 90) {
            EXPECT_NEAR(longitude_apart(place.longitude.deg(), row.number("lon_deg")), 0, row.number("tol_deg"));
        }
    }
}

TEST(GeodeticVectors, AgreeWithTheTranscribedCoordinates) {
    SKYLOOP_REQUIRE_SHARED(path, "vectors/coordinates.csv");
    std::ifstream file(path);
    int rows = 0;
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with('#') || line.starts_with("x_m")) continue;
        std::istringstream cells(line);
        std::array<double, 6> value{};
        for (double& number : value) {
            std::string cell;
            std::getline(cells, cell, ',');
            number = std::stod(cell);
        }
        const Geodetic place = to_geodetic({value[0], value[1], value[2]});
        EXPECT_NEAR(place.latitude.deg(), value[3], 1e-7) << line;
        EXPECT_NEAR(place.longitude.deg(), value[4], 1e-7) << line;
        EXPECT_NEAR(place.height.above_ellipsoid.value(), value[5], 1e-4) << line;
        const Position<Ecef> back = to_ecef(Geodetic::degrees(value[3], value[4], value[5]));
        // The longitude is written to 1e-8 degrees, half of which is half a millimetre.
        EXPECT_LE((back.vector() - Eigen::Vector3d(value[0], value[1], value[2])).norm(), 6e-4) << line;
        ++rows;
    }
    EXPECT_EQ(rows, 2);
}

TEST(Geodetic, ComesBackUnchanged) {
    RandomStream random(1, "test.geodetic");
    for (int i = 0; i < 20'000; ++i) {
        const double latitude = 180 * random.uniform() - 90;
        const double longitude = 360 * random.uniform() - 180;
        const double height = -5000 + 3e7 * std::pow(random.uniform(), 4);
        const Geodetic back = to_geodetic(to_ecef(Geodetic::degrees(latitude, longitude, height)));
        ASSERT_NEAR(back.latitude.deg(), latitude, 1e-12 * 100);
        // A millionth of a millimetre on the ground, whatever the latitude.
        ASSERT_NEAR(longitude_apart(back.longitude.deg(), longitude) * std::cos(back.latitude.rad()), 0, 1e-12 * 100);
        ASSERT_NEAR(back.height.above_ellipsoid.value(), height, 1e-7);
    }
}

TEST(Geodetic, PolesAndDateLine) {
    const double polar_radius = 6356752.314245179;
    const Geodetic north = to_geodetic({0, 0, polar_radius + 100});
    EXPECT_DOUBLE_EQ(north.latitude.deg(), 90);
    EXPECT_NEAR(north.height.above_ellipsoid.value(), 100, 1e-8);
    const Geodetic south = to_geodetic({0, 0, -polar_radius});
    EXPECT_DOUBLE_EQ(south.latitude.deg(), -90);
    for (const double longitude : {-180.0, 0.0, 77.0, 180.0})
        EXPECT_NEAR(to_ecef(Geodetic::degrees(90, longitude, 0)).vector().z(), polar_radius, 1e-8);

    // Both names of the date line are one place, and a step across it is a short one.
    const Eigen::Vector3d east = to_ecef(Geodetic::degrees(-17, 180, 5)).vector();
    EXPECT_LE((east - to_ecef(Geodetic::degrees(-17, -180, 5)).vector()).norm(), 1e-8);
    const Eigen::Vector3d step = to_ecef(Geodetic::degrees(-17, -179.9999, 5)).vector() - east;
    EXPECT_NEAR(step.norm(), 10.65, 0.01);
    EXPECT_EQ(std::abs(to_geodetic({-6378137, 0, 0}).longitude.deg()), 180);
}

TEST(Geodetic, TheCentreOfTheEarthIsANumberToo) {
    const Geodetic centre = to_geodetic({0, 0, 0});
    EXPECT_TRUE(std::isfinite(centre.latitude.deg()));
    EXPECT_TRUE(std::isfinite(centre.longitude.deg()));
    EXPECT_LT(centre.height.above_ellipsoid.value(), -6.3e6);
}

TEST(CurvatureRadii, AreThoseOfWgs84) {
    const double a = 6378137;
    const double b = 6356752.314245179;
    const CurvatureRadii equator = curvature_radii(Angle::degrees(0));
    EXPECT_NEAR(equator.prime_vertical, a, 1e-6);
    EXPECT_NEAR(equator.meridian, b * b / a, 1e-6);
    const CurvatureRadii pole = curvature_radii(Angle::degrees(-90));
    EXPECT_NEAR(pole.prime_vertical, a * a / b, 1e-6);
    EXPECT_NEAR(pole.meridian, a * a / b, 1e-6);
}

// A small step in latitude is M·dφ long and one in longitude N·cos φ·dλ.
TEST(CurvatureRadii, GiveTheLengthOfASmallStep) {
    const double step = 1e-4;
    for (const double latitude : {-80.0, -33.3, 0.0, 46.4774, 88.0}) {
        const CurvatureRadii radii = curvature_radii(Angle::degrees(latitude));
        const auto distance = [&](double dlat, double dlon) {
            const Eigen::Vector3d from = to_ecef(Geodetic::degrees(latitude - dlat / 2, -dlon / 2, 0)).vector();
            return (to_ecef(Geodetic::degrees(latitude + dlat / 2, dlon / 2, 0)).vector() - from).norm();
        };
        const double radians = Angle::degrees(step).rad();
        EXPECT_NEAR(distance(step, 0), radii.meridian * radians, 1e-7);
        EXPECT_NEAR(distance(0, step), radii.prime_vertical * std::cos(Angle::degrees(latitude).rad()) * radians, 1e-7);
    }
}

TEST(MslHeight, IsHeightMinusUndulation) {
    const MslHeight height = above_sea_level(EllipsoidalHeight{Metres(77)}, Metres(27.5));
    EXPECT_DOUBLE_EQ(height.above_sea_level.value(), 49.5);
}

TEST(PlaceFromDegrees, TakesPlacesOfTheEarthOnly) {
    EXPECT_NEAR(place_from_degrees(-90, 350, 10).value().longitude.deg(), -10, 1e-12);
    EXPECT_EQ(place_from_degrees(90.1, 0, 0).error(), "latitude is 90.1; expected -90 to 90 degrees");
    EXPECT_EQ(place_from_degrees(90.0000001, 0, 0).error(), "latitude is 90.0000001; expected -90 to 90 degrees");
    EXPECT_EQ(place_from_degrees(0, -361, 0).error(), "longitude is -361; expected -360 to 360 degrees");
    EXPECT_FALSE(place_from_degrees(0, 0, 1.1e7));
    EXPECT_FALSE(place_from_degrees(0, 0, -1.1e4));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(place_from_degrees(nan, 0, 0));
    EXPECT_FALSE(place_from_degrees(0, nan, 0));
    EXPECT_FALSE(place_from_degrees(0, 0, nan));
}

}  // namespace
}  // namespace skyloop
