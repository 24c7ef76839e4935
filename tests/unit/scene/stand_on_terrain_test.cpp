#include "world/scene/urban_scene.hpp"

#include <gtest/gtest.h>

namespace skyloop {
namespace {

using Eigen::Vector3d;

/// A slope that rises one in ten to the east, 200 m to either side.
std::shared_ptr<const UrbanScene> slope() {
    CityModel model;
    model.add_quad({Vector3d(-200, -200, 80), {200, -200, 120}, {200, 200, 120}, {-200, 200, 80}}, SurfaceKind::ground);
    const auto scene = UrbanScene::build(model);
    EXPECT_TRUE(scene);
    return *scene;
}

/// Two walls of one building, 10 m tall, from `east` to 20 m beyond; the ground was taken to be at 5 m.
void add_tower(CityModel& city, double east) {
    const auto first = static_cast<std::uint32_t>(city.vertices.size());
    for (const double wall : {east, east + 20})
        city.add_quad({Vector3d(wall, 0, 5), {wall, 9, 5}, {wall, 9, 15}, {wall, 0, 15}}, SurfaceKind::wall);
    city.grounded.push_back({first, static_cast<std::uint32_t>(city.vertices.size()) - first, 5});
}

TEST(StandOnTerrain, ABuildingStandsOnTheLowestGroundBelowIt) {
    CityModel city;
    city.add_triangle({Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 0, 1)}, SurfaceKind::wall);
    add_tower(city, 50);
    add_tower(city, -50);
    const std::vector<Vector3d> before = city.vertices;
    EXPECT_EQ(stand_on_terrain(city, *slope()), 0U);
    for (std::size_t i = 0; i < before.size(); ++i) {
        const double shift = i < 3 ? 0 : i < 11 ? 100 : 90;
        EXPECT_NEAR((city.vertices[i] - before[i] - Vector3d(0, 0, shift)).norm(), 0, 1e-4) << i;
    }
    EXPECT_NEAR(city.grounded[1].ground, 95, 1e-4);
}

TEST(StandOnTerrain, WoodsClimbTheSlope) {
    CityModel city;
    city.foliage.push_back({{{-150, 0}, {150, 0}, {150, 30}, {-150, 30}}, 3, 12, 0});
    city.foliage.push_back({{{-150, 0}, {150, 0}, {150, 30}, {-150, 30}}, 3, 12, std::nullopt});
    EXPECT_EQ(stand_on_terrain(city, *slope()), 0U);
    ASSERT_EQ(city.foliage.size(), 9U);
    EXPECT_EQ(city.foliage.back().base, 3) << "the file told its height";
    for (std::size_t i = 0; i < 8; ++i) {
        const FoliageVolume& trees = city.foliage[i];
        double east = 0;
        for (const Eigen::Vector2d& corner : trees.ring)
            east += corner.x() / static_cast<double>(trees.ring.size());
        EXPECT_NEAR(trees.base, 100 + east / 10 + 3, 1e-3);
        EXPECT_NEAR(trees.top - trees.base, 9, 1e-9);
    }
}

TEST(StandOnTerrain, WhatIsBeyondStaysAndIsCounted) {
    CityModel city;
    add_tower(city, 500);
    city.foliage.push_back({{{900, 0}, {950, 0}, {950, 30}}, 3, 12, 0});
    const std::vector<Vector3d> before = city.vertices;
    EXPECT_EQ(stand_on_terrain(city, *slope()), 2U);
    EXPECT_EQ(city.vertices, before);
    EXPECT_EQ(city.foliage.front().top, 12);
}

}  // namespace
}  // namespace skyloop
