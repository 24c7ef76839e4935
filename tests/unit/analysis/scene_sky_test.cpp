#include "study/analysis/scene_sky.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/analysis/scene_shapes.hpp"
#include "world/scene/path_finder.hpp"

namespace skyloop {
namespace {

using test::canyon_scene;
using test::scene_origin;
using test::wall_scene;

constexpr double degree = std::numbers::pi / 180;

TEST(SkyMask, of_a_canyon_is_the_arctangent_of_height_over_distance) {
    constexpr double half_width = 10, wall = 30, antenna = 1.5;
    const SkyMask mask = sky_mask(*canyon_scene(half_width, wall), {0, 0, antenna});
    for (int azimuth = 10; azimuth < 170; ++azimuth) {
        const double across = half_width / std::sin((azimuth + 0.5) * degree);
        const double edge = std::atan((wall - antenna) / across) / degree;
        // A cell is decided at its middle: its upper edge is within half a degree of the wall's.
        EXPECT_NEAR(mask.highest(azimuth), edge, 0.5 + 1e-6) << azimuth;
        EXPECT_EQ(mask.highest(359 - azimuth), mask.highest(azimuth)) << "the canyon is symmetric";
    }
}

TEST(SkyMask, of_one_wall_is_open_on_the_other_side) {
    const SkyMask mask = sky_mask(*wall_scene(20, 15), {0, 0, 0});
    for (int azimuth = 185; azimuth < 355; ++azimuth)
        EXPECT_EQ(mask.highest(azimuth), 0) << azimuth;
    EXPECT_NEAR(mask.highest(90), std::atan(15.0 / 20) / degree, 0.5);
    // The wall hides the part of the sky below a plane that is tilted by arctan(15/20) about the street: half of the
    // sphere's lune of that angle.
    EXPECT_NEAR(mask.open_share(), 1 - std::atan(15.0 / 20) / std::numbers::pi, 0.005);
}

TEST(SceneSky, tells_where_a_wall_reflects_and_by_how_much_the_way_is_longer) {
    // Two walls 40 m apart, the western one high enough to hide a satellite at 30° in the west.
    CityModel city;
    city.origin = scene_origin();
    for (const auto& [east, height] : {std::pair{-20.0, 40.0}, {20.0, 40.0}})
        city.add_quad({Eigen::Vector3d(east, -500, 0), Eigen::Vector3d(east, 500, 0),
                       Eigen::Vector3d(east, 500, height), Eigen::Vector3d(east, -500, height)},
                      SurfaceKind::wall);
    const auto scene = UrbanScene::build(city).value();
    const double elevation = 50 * degree;
    const Eigen::Vector3d antenna(-10, 0, 1.5);
    const Eigen::Vector3d towards(-std::cos(elevation), 0, std::sin(elevation));
    const SceneSatellite satellite{{Constellation::gps, 7}, antenna + 2.2e7 * towards, Eigen::Vector3d::Zero()};
    PathSearchSettings settings;
    settings.search_ahead = false;
    settings.rays = 16384;
    PathFinder finder(scene, settings);
    const auto found = finder.epoch({GpsTime{}, antenna}, std::span(&satellite, 1));
    // The ray to the west passes the wall at 1.5 + 10 tan 50° = 13 m: blocked. The one from the east wall comes over
    // 1.5 + 30 tan 50° = 37 m and passes the west wall at 85 m.
    const SceneReception reception = scene_reception(*scene, found.front(), antenna);
    EXPECT_EQ(reception.reception(), Reception::reflected);
    ASSERT_FALSE(reception.paths.empty());
    const ReflectedPath& path = reception.paths.front();
    ASSERT_EQ(path.points.size(), 1u);
    EXPECT_EQ(path.surfaces.front(), SurfaceKind::wall);
    EXPECT_NEAR(path.points[0].x(), 20, 1e-6);
    EXPECT_NEAR(path.points[0].z(), 1.5 + 30 * std::tan(elevation), 1e-3);
    EXPECT_NEAR(path.arrival.azimuth.deg(), 90, 1e-3);
    EXPECT_NEAR(path.arrival.elevation.deg(), 50, 1e-2);
    EXPECT_NEAR(path.excess.value(), 2 * 30 * std::cos(elevation), 1e-3);
    EXPECT_NEAR(path.loss.value(), 3.0103, 1e-4);
    const Eigen::Vector3d back = scene->frame().to_enu(to_ecef(path.places[0])).vector();
    EXPECT_LT((back - path.points[0]).norm(), 1e-6);
}

}  // namespace
}  // namespace skyloop
