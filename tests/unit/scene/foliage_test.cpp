#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/core/random.hpp"
#include "world/scene/urban_scene.hpp"

namespace skyloop {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

FoliageVolume square_grove() { return {{{10, -5}, {20, -5}, {20, 5}, {10, 5}}, 2, 12}; }

double metres_in(const FoliageVolume& volume, const Vector3d& origin, const Vector3d& direction) {
    return foliage_length(std::span(&volume, 1), {origin, direction.normalized()});
}

TEST(Foliage, LevelRayCrossesTheWholeGrove) {
    EXPECT_NEAR(metres_in(square_grove(), {0, 0, 5}, {1, 0, 0}), 10, 1e-12);
    EXPECT_NEAR(metres_in(square_grove(), {0, -15, 5}, {1, 1, 0}), 10 * std::sqrt(2.0), 1e-12);
}

TEST(Foliage, SlantedRayComesInBelowAndLeavesByTheSide) {
    // Rises one in two: at the base 4 m away, at the near side 5 m up, at the far side 10 m up.
    EXPECT_NEAR(metres_in(square_grove(), {0, 0, 0}, {2, 0, 1}), 10 * std::sqrt(1.25), 1e-12);
    // From below the grove, up through its base and out of its side 5 m higher.
    EXPECT_NEAR(metres_in(square_grove(), {13, 0, 0}, {1, 0, 1}), 5 * std::sqrt(2.0), 1e-12);
    // In by the side, out by the top.
    EXPECT_NEAR(metres_in(square_grove(), {5, 0, 5}, {1, 0, 1}), 2 * std::sqrt(2.0), 1e-12);
}

TEST(Foliage, PlumbRayPassesFromBaseToTop) {
    EXPECT_NEAR(metres_in(square_grove(), {15, 0, 0}, {0, 0, 1}), 10, 1e-12);
    EXPECT_NEAR(metres_in(square_grove(), {15, 0, 50}, {0, 0, -1}), 10, 1e-12);
    EXPECT_EQ(metres_in(square_grove(), {25, 0, 0}, {0, 0, 1}), 0);
}

TEST(Foliage, RayThatBeginsInsideCountsFromThere) {
    EXPECT_NEAR(metres_in(square_grove(), {14, 0, 5}, {1, 0, 0}), 6, 1e-12);
    EXPECT_NEAR(metres_in(square_grove(), {14, 0, 5}, {-1, 0, 0}), 4, 1e-12);
    EXPECT_NEAR(metres_in(square_grove(), {15, 0, 5}, {0, 0, 1}), 7, 1e-12);
}

TEST(Foliage, BeyondTheLengthOfTheRayNothingCounts) {
    const FoliageVolume grove = square_grove();
    const auto metres_within = [&grove](double length) {
        return foliage_length(std::span(&grove, 1), {{0, 0, 5}, {1, 0, 0}}, length);
    };
    EXPECT_EQ(metres_within(0), 0);
    EXPECT_EQ(metres_within(9), 0);
    EXPECT_NEAR(metres_within(13), 3, 1e-12);
    EXPECT_NEAR(metres_within(30), 10, 1e-12);
    EXPECT_NEAR(foliage_length(std::span(&grove, 1), {{15, 0, 0}, {0, 0, 1}}, 7), 5, 1e-12);
}

TEST(Foliage, WhatIsBehindOrBesideDoesNotCount) {
    EXPECT_EQ(metres_in(square_grove(), {0, 0, 5}, {-1, 0, 0}), 0);
    EXPECT_EQ(metres_in(square_grove(), {0, 0, 13}, {1, 0, 0}), 0);
    EXPECT_EQ(metres_in(square_grove(), {0, 0, 1}, {1, 0, 0}), 0);
    EXPECT_EQ(metres_in(square_grove(), {0, 0, 5}, {1, 2, 0}), 0);
    EXPECT_EQ(metres_in(square_grove(), {0, 0, 13}, {1, 0, 0.1}), 0);
}

TEST(Foliage, EitherSenseOfTheRingIsTheSame) {
    FoliageVolume turned = square_grove();
    std::ranges::reverse(turned.ring);
    EXPECT_NEAR(metres_in(turned, {0, 1, 3}, {3, 1, 1}), metres_in(square_grove(), {0, 1, 3}, {3, 1, 1}), 1e-12);
}

TEST(Foliage, AGapBetweenTwoArmsDoesNotCount) {
    // A U open to the north, arms 2 m wide and 6 m apart.
    const FoliageVolume horseshoe{{{0, 0}, {10, 0}, {10, 10}, {8, 10}, {8, 2}, {2, 2}, {2, 10}, {0, 10}}, 0, 10};
    EXPECT_NEAR(metres_in(horseshoe, {-5, 5, 1}, {1, 0, 0}), 4, 1e-12);
    EXPECT_NEAR(metres_in(horseshoe, {-5, 1, 1}, {1, 0, 0}), 10, 1e-12);
    EXPECT_NEAR(metres_in(horseshoe, {5, 20, 1}, {0, -1, 0}), 2, 1e-12);
    EXPECT_NEAR(metres_in(horseshoe, {5, 5, 1}, {1, 0, 0}), 2, 1e-12);
}

TEST(Foliage, RayThroughTwoCornersCountsOnce) {
    const FoliageVolume diamond{{{0, -5}, {5, 0}, {0, 5}, {-5, 0}}, 0, 10};
    EXPECT_NEAR(metres_in(diamond, {-20, 0, 1}, {1, 0, 0}), 10, 1e-12);
    EXPECT_EQ(metres_in(diamond, {-20, 5, 1}, {1, 0, 0}), 0);
}

TEST(Foliage, LengthsInSeveralGrovesAdd) {
    FoliageVolume far = square_grove();
    far.ring[2].x() = far.ring[1].x() = 14;
    for (Vector2d& corner : far.ring)
        corner.x() += 30;
    const std::vector groves{square_grove(), far};
    EXPECT_NEAR(foliage_length(groves, {{0, 0, 5}, {1, 0, 0}}), 14, 1e-12);
    EXPECT_NEAR(foliage_length(groves, {{30, 0, 5}, {1, 0, 0}}), 4, 1e-12);
    EXPECT_EQ(foliage_length({}, {{0, 0, 5}, {1, 0, 0}}), 0);
}

TEST(Foliage, AMetreInSeveralGrovesIsOneMetre) {
    FoliageVolume shifted = square_grove(), within = square_grove();
    for (Vector2d& corner : shifted.ring)
        corner.x() += 5;
    within.ring = {{12, -1}, {14, -1}, {14, 1}, {12, 1}};
    const SceneRay ray{{0, 0, 5}, {1, 0, 0}};
    EXPECT_NEAR(foliage_length(std::vector{square_grove(), square_grove()}, ray), 10, 1e-12);
    EXPECT_NEAR(foliage_length(std::vector{square_grove(), shifted}, ray), 15, 1e-12);
    EXPECT_NEAR(foliage_length(std::vector{shifted, square_grove()}, ray), 15, 1e-12);
    EXPECT_NEAR(foliage_length(std::vector{square_grove(), within, shifted}, ray), 15, 1e-12);
    EXPECT_NEAR(foliage_length(std::vector{within, square_grove()}, ray), 10, 1e-12);
}

TEST(Foliage, VolumesWithoutAnInsideLoseNothing) {
    EXPECT_EQ(metres_in({{}, 0, 10}, {0, 0, 5}, {1, 0, 0}), 0);
    EXPECT_EQ(metres_in({{{10, -5}, {10, 5}}, 0, 10}, {0, 0, 5}, {1, 0, 0}), 0);
    FoliageVolume flat = square_grove();
    flat.top = flat.base;
    EXPECT_EQ(metres_in(flat, {0, 0, 2}, {1, 0, 0}), 0);
    EXPECT_EQ(metres_in(flat, {0, 0, 0}, {7, 0, 1}), 0);
}

/// Length of a ray in a box along the axes, by its three pairs of planes.
double metres_in_box(const Vector3d& low, const Vector3d& high, const SceneRay& ray) {
    double first = 0, last = 1e9;
    for (int i = 0; i < 3; ++i) {
        const double a = (low[i] - ray.origin[i]) / ray.direction[i], b = (high[i] - ray.origin[i]) / ray.direction[i];
        first = std::max(first, std::min(a, b));
        last = std::min(last, std::max(a, b));
    }
    return std::max(0.0, last - first);
}

TEST(Foliage, AgreesWithTheClosedFormOfABoxForAnyRay) {
    RandomStream random(4, "foliage");
    const FoliageVolume grove = square_grove();
    int crossed = 0;
    for (int i = 0; i < 20'000; ++i) {
        const SceneRay ray{{30 * random.uniform(), 30 * random.uniform() - 15, 20 * random.uniform()},
                           Vector3d(random.normal(), random.normal(), random.normal()).normalized()};
        const double metres = metres_in_box({10, -5, 2}, {20, 5, 12}, ray);
        crossed += metres > 0;
        ASSERT_NEAR(foliage_length(std::span(&grove, 1), ray), metres, 1e-9) << i;
    }
    EXPECT_GT(crossed, 2'000);
}

/// Thousands of small woods, a few wide ones, and some that have no inside.
CityModel woodland() {
    RandomStream random(7, "woodland");
    CityModel city;
    city.add_triangle({Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 0, 1)}, SurfaceKind::wall);
    for (int i = 0; i < 3000; ++i) {
        const double size = i % 500 == 0 ? 700 : 25, base = 4 * random.uniform();
        const Vector2d middle(3000 * random.normal(), 3000 * random.normal());
        FoliageVolume trees{{}, base, i % 400 == 1 ? base : base + 20 * random.uniform()};
        for (int corner = 0; corner < 7 && i % 300 != 2; ++corner)
            trees.ring.push_back(middle + size * Vector2d(std::cos(corner), std::sin(corner)));
        city.foliage.push_back(trees);
    }
    return city;
}

TEST(Foliage, TheSceneFindsEveryCrownThatARayPasses) {
    const CityModel city = woodland();
    const auto scene = UrbanScene::build(city);
    ASSERT_TRUE(scene);
    RandomStream random(8, "rays");
    int crossed = 0;
    for (int i = 0; i < 2000; ++i) {
        Vector3d towards(random.normal(), random.normal(), i % 3 == 0 ? 0 : 0.1 * random.normal());
        if (i % 50 == 0) towards = {0, 0, 1};
        if (i % 50 == 1) towards = {0, 1, 0};
        const SceneRay ray{{4000 * random.normal(), 4000 * random.normal(), 10 * random.uniform()},
                           towards.normalized()};
        const double metres = foliage_length(city.foliage, ray);
        crossed += metres > 0;
        ASSERT_EQ((*scene)->length_in_foliage(ray), metres) << i;
        ASSERT_EQ((*scene)->length_in_foliage(ray, 500), foliage_length(city.foliage, ray, 500)) << i;
    }
    EXPECT_GT(crossed, 500);
}

}  // namespace
}  // namespace skyloop
