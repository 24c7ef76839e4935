// Sun and Moon against J. Meeus, Astronomical Algorithms, and against the places that the IERS's own program for tides
// is tested with (DEHANTTIDEINEL.F of the software of the IERS Conventions (2010), test cases 1 to 3).
#include "world/gnss/sun_and_moon.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

#include "base/geo/geodetic.hpp"
#include "base/time/utc_time.hpp"

namespace skyloop::test {
namespace {

using namespace std::chrono_literals;

constexpr double degree_of_angle = std::numbers::pi / 180;

double declination_deg(const Position<Ecef>& p) { return std::asin(p.vector().normalized().z()) / degree_of_angle; }

double right_ascension_deg(const Position<Ecef>& p, GpsTime time) {
    const double angle = std::atan2(p.vector().y(), p.vector().x()) + sidereal_time(time);
    return std::fmod(angle / degree_of_angle + 720, 360);
}

TEST(SiderealTime, IsThatOfMeeus) {
    // Example 12.a: 1987-04-10T00:00:00 UT, 13h10m46.3668s, less what UT1 is apart from UTC then (0.3 s).
    EXPECT_NEAR(sidereal_time(to_gps_time({1987, 4, 10, 0, 0, 0}, LeapSeconds::announced())) / degree_of_angle,
                197.693195, 1e-5);
}

TEST(SunPosition, IsThatOfMeeus) {
    const GpsTime dynamic = gps_calendar_time(1992, 10, 13, 0, 0, 0) - 51184ms;  // example 25.a
    const Position<Ecef> sun = sun_position(dynamic);
    EXPECT_NEAR(right_ascension_deg(sun, dynamic), 198.38083, 0.01);
    EXPECT_NEAR(declination_deg(sun), -7.78507, 0.01);
    EXPECT_NEAR(sun.vector().norm() / 1.495978707e11, 0.99766, 2e-4);
}

TEST(MoonPosition, IsThatOfMeeus) {
    const GpsTime dynamic = gps_calendar_time(1992, 4, 12, 0, 0, 0) - 51184ms;  // example 47.a
    const Position<Ecef> moon = moon_position(dynamic);
    EXPECT_NEAR(right_ascension_deg(moon, dynamic), 134.688470, 0.02);
    EXPECT_NEAR(declination_deg(moon), 13.768368, 0.02);
    EXPECT_NEAR(moon.vector().norm() / 1e3, 368409.7, 100);
}

// Total eclipse of 2017-08-21, greatest at 18:25:31 UT over 36°58'N, 87°40'W (NASA's catalogue of solar eclipses).
TEST(SunAndMoon, StandInOneLineInAnEclipse) {
    const GpsTime time = to_gps_time({2017, 8, 21, 18, 25, 31}, LeapSeconds::announced());
    const Position<Ecef> place = to_ecef(Geodetic::degrees(36.97, -87.67, 0));
    const Eigen::Vector3d sun = (sun_position(time) - place).vector().normalized();
    const Eigen::Vector3d moon = (moon_position(time) - place).vector().normalized();
    EXPECT_LT(std::acos(sun.dot(moon)) / degree_of_angle, 0.05);
    EXPECT_NEAR(std::asin(sun.dot(place.vector().normalized())) / degree_of_angle, 64, 0.5) << "the Sun's elevation";
}

TEST(YawSteering, LooksAtTheEarthAndHasTheSunOnItsSide) {
    const Position<Ecef> satellite(2.6e7, 0, 0), sun(1e11, 1e11, 3e10);
    const SatelliteAxes axes = yaw_steering(satellite, sun);
    EXPECT_NEAR((axes.z - Eigen::Vector3d(-1, 0, 0)).norm(), 0, 1e-15);
    const Eigen::Vector3d to_sun = (sun - satellite).vector().normalized();
    EXPECT_NEAR(axes.y.dot(to_sun), 0, 1e-15) << "the panels' axis stands across the Sun's rays";
    EXPECT_GT(axes.x.dot(to_sun), 0);
    EXPECT_NEAR((axes.x.cross(axes.y) - axes.z).norm(), 0, 1e-15) << "right-handed";
    const SatelliteAxes below = yaw_steering(satellite, Position<Ecef>(1.5e11, 0, 0));
    EXPECT_NEAR(below.x.cross(below.y).dot(below.z), 1, 1e-12) << "exactly below the Sun, too";
}

}  // namespace
}  // namespace skyloop::test
