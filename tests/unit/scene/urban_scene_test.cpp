#include "skyloop/scene/urban_scene.hpp"

#include <gtest/gtest.h>

namespace skyloop {
namespace {

CityModel one_wall() {
    CityModel city;
    city.origin = Geodetic::degrees(48.1, 11.6, 500);
    city.add_quad({Eigen::Vector3d(10, -50, 0), {10, 50, 0}, {10, 50, 30}, {10, -50, 30}}, SurfaceKind::wall);
    return city;
}

TEST(UrbanScene, FindsAWallAtItsDistance) {
    const auto scene = UrbanScene::build(one_wall());
    ASSERT_TRUE(scene);
    EXPECT_EQ((*scene)->planes().size(), 1U);
    const SceneHit hit = (*scene)->first_hit({{0, 0, 1.5}, Eigen::Vector3d(1, 1, 0.1).normalized()});
    ASSERT_TRUE(hit.any());
    EXPECT_NEAR(hit.distance, 10 * std::sqrt(2.01), 1e-9);
    EXPECT_FALSE((*scene)->first_hit({{0, 0, 1.5}, {-1, 0, 0}}).any());
    EXPECT_TRUE((*scene)->blocked({{0, 0, 1.5}, {1, 0, 0}}));
    EXPECT_FALSE((*scene)->blocked({{0, 0, 1.5}, {1, 0, 0}}, 9.9));
    EXPECT_GT((*scene)->statistics().memory, 0U);
}

}  // namespace
}  // namespace skyloop
