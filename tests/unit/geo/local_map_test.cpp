#include "base/geo/simulator_frames.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/geo/local_frame.hpp"

namespace skyloop {
namespace {

const Geodetic map_origin = Geodetic::degrees(47.3977, 8.5456, 500);
constexpr LocalMap all_maps[] = {LocalMap::tangent, LocalMap::ardupilot_flat, LocalMap::px4_azimuthal,
                                 LocalMap::airsim_sphere};

double metres_between(const Geodetic& a, const Geodetic& b) { return (to_ecef(a) - to_ecef(b)).length().value(); }

TEST(LocalMap, EveryMapLeavesItsOriginWhereItIs) {
    for (const LocalMap map : all_maps)
        EXPECT_LT(metres_between(place_on_map(map, map_origin, {0, 0, 0}), map_origin), 1e-6) << static_cast<int>(map);
}

TEST(LocalMap, IsKnownByItsName) {
    EXPECT_EQ(local_map_of_name("tangent"), LocalMap::tangent);
    EXPECT_EQ(local_map_of_name("ardupilot_flat"), LocalMap::ardupilot_flat);
    EXPECT_EQ(local_map_of_name("px4_azimuthal"), LocalMap::px4_azimuthal);
    EXPECT_EQ(local_map_of_name("airsim_sphere"), LocalMap::airsim_sphere);
    EXPECT_FALSE(local_map_of_name("mercator"));
}

TEST(LocalMap, TheTangentPlaneIsExact) {
    const Eigen::Vector3d ned(1000, 2000, -30);
    const Position<Enu> enu = LocalFrame(map_origin).to_enu(to_ecef(place_on_map(LocalMap::tangent, map_origin, ned)));
    EXPECT_NEAR(enu.vector().x(), 2000, 1e-6);
    EXPECT_NEAR(enu.vector().y(), 1000, 1e-6);
    EXPECT_NEAR(enu.vector().z(), 30, 1e-6);
}

TEST(LocalMap, ArdupilotCountsDegreesOf111318Metres) {
    const Geodetic place = place_on_map(LocalMap::ardupilot_flat, map_origin, {1113.18845, 0, -7});
    EXPECT_NEAR(place.latitude.deg(), 47.4077, 1e-12);
    EXPECT_NEAR(place.longitude.deg(), 8.5456, 1e-12);
    EXPECT_NEAR(place.height.above_ellipsoid.value(), 507, 1e-9);
    // cos 47.3977° = 0.676905518.
    const Geodetic east = place_on_map(LocalMap::ardupilot_flat, map_origin, {0, 1113.18845 * 0.676905518, 0});
    EXPECT_NEAR(east.longitude.deg(), 8.5556, 1e-7);
}

TEST(LocalMap, Px4AndAirsimCountOnTheirSpheres) {
    const double degree = std::numbers::pi / 180;
    const Geodetic px4 = place_on_map(LocalMap::px4_azimuthal, map_origin, {0.1 * degree * 6371000, 0, 0});
    EXPECT_NEAR(px4.latitude.deg(), 47.4977, 1e-10);
    const Geodetic airsim = place_on_map(LocalMap::airsim_sphere, map_origin, {0.1 * degree * 6378137, 0, 0});
    EXPECT_NEAR(airsim.latitude.deg(), 47.4977, 1e-10);
    // Along the equator an arc is a longitude.
    const Geodetic equator = Geodetic::degrees(0, 179.95, 0);
    const Geodetic beyond = place_on_map(LocalMap::px4_azimuthal, equator, {0, 0.1 * degree * 6371000, 0});
    EXPECT_NEAR(beyond.longitude.deg(), -179.95, 1e-10);
}

// What the choice is about: the maps part by metres in a kilometre, and by no more than 0.4 % of the distance.
TEST(LocalMap, MapsPartByMetresInAKilometre) {
    for (const LocalMap map : {LocalMap::ardupilot_flat, LocalMap::px4_azimuthal, LocalMap::airsim_sphere}) {
        const Eigen::Vector3d ned(700, 700, 0);
        const double apart =
            metres_between(place_on_map(map, map_origin, ned), place_on_map(LocalMap::tangent, map_origin, ned));
        EXPECT_GT(apart, 0.5) << static_cast<int>(map);
        EXPECT_LT(apart, 4) << static_cast<int>(map);
    }
}

TEST(LocalMap, AxesOfTheTangentPlaneStayThoseOfItsOrigin) {
    const Geodetic place = place_on_map(LocalMap::tangent, map_origin, {0, 100000, 0});
    EXPECT_TRUE(axes_on_map(LocalMap::tangent, map_origin, place).isApprox(ned_to_ecef(map_origin).toRotationMatrix()));
    EXPECT_TRUE(
        axes_on_map(LocalMap::ardupilot_flat, map_origin, place).isApprox(ned_to_ecef(place).toRotationMatrix()));
    const Eigen::Vector3d down = ned_to_ecef(map_origin) * Eigen::Vector3d(0, 0, 1);
    Geodetic below = map_origin;
    below.height.above_ellipsoid -= Metres(1);
    EXPECT_TRUE(down.isApprox((to_ecef(below) - to_ecef(map_origin)).vector(), 1e-6));
}

}  // namespace
}  // namespace skyloop
