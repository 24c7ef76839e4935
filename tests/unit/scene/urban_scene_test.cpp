#include "world/scene/urban_scene.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <thread>

#include "base/core/random.hpp"

namespace skyloop {
namespace {

using Eigen::Vector3d;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

CityModel one_wall() {
    CityModel city;
    city.add_quad({Vector3d(10, -50, 0), {10, 50, 0}, {10, 50, 30}, {10, -50, 30}}, SurfaceKind::wall);
    return city;
}

/// Every side of a box in so many quadrilaterals each way.
void add_box(CityModel& city, const Vector3d& low, const Vector3d& high, int parts, double turn = 0) {
    const Eigen::Matrix3d rotation = Eigen::AngleAxisd(turn, Vector3d::UnitZ()).toRotationMatrix();
    const Vector3d middle = (low + high) / 2, size = high - low;
    const auto side = [&](const Vector3d& corner, const Vector3d& along, const Vector3d& across, SurfaceKind kind) {
        const auto place = [&](int i, int j) -> Vector3d {
            return middle + rotation * (corner + along * i / parts + across * j / parts - middle);
        };
        for (int i = 0; i < parts; ++i)
            for (int j = 0; j < parts; ++j)
                city.add_quad({place(i, j), place(i + 1, j), place(i + 1, j + 1), place(i, j + 1)}, kind);
    };
    const Vector3d x(size.x(), 0, 0), y(0, size.y(), 0), z(0, 0, size.z());
    side(low, x, z, SurfaceKind::wall);
    side(low + y, x, z, SurfaceKind::wall);
    side(low, y, z, SurfaceKind::wall);
    side(low + x, y, z, SurfaceKind::wall);
    side(low, x, y, SurfaceKind::roof);
    side(low + z, x, y, SurfaceKind::roof);
}

CityModel some_houses(int houses) {
    RandomStream random(11, "houses");
    CityModel city;
    for (int i = 0; i < houses; ++i) {
        // Their bottoms are below the ground: two facets in one place would be met as it comes.
        const Vector3d low(40.0 * (i % 20), 40.0 * (i / 20), -1);
        add_box(city, low,
                low + Vector3d(10 + 15 * random.uniform(), 10 + 15 * random.uniform(), 8 + 30 * random.uniform()), 1,
                random.uniform());
    }
    city.add_quad({Vector3d(-300, -300, 0), {1'100, -300, 0}, {1'100, 1'100, 0}, {-300, 1'100, 0}},
                  SurfaceKind::ground);
    return city;
}

std::vector<SceneRay> rays_from(const Vector3d& place, double spread, int count) {
    RandomStream random(12, "rays");
    std::vector<SceneRay> rays;
    for (int i = 0; i < count; ++i)
        rays.push_back({place + spread * Vector3d(random.uniform(), random.uniform(), 0),
                        Vector3d(random.normal(), random.normal(), random.normal()).normalized()});
    return rays;
}

std::shared_ptr<const UrbanScene> built(const CityModel& city) {
    auto scene = UrbanScene::build(city);
    EXPECT_TRUE(scene) << scene.error().message;
    return *scene;
}

std::string why_not(const CityModel& city, const SceneSettings& settings = {}) {
    const auto scene = UrbanScene::build(city, settings);
    if (scene) return "it was built";
    EXPECT_EQ(scene.error().code, ErrorCode::input);
    return scene.error().message;
}

TEST(UrbanScene, FindsAWallAtItsDistance) {
    const auto scene = built(one_wall());
    const SceneHit hit = scene->first_hit({{0, 0, 1.5}, Vector3d(1, 1, 0.1).normalized()});
    ASSERT_TRUE(hit.any());
    EXPECT_EQ(hit.plane, 0U);
    EXPECT_EQ(scene->plane_of(hit.triangle), 0U);
    EXPECT_NEAR(hit.distance, 10 * std::sqrt(2.01), 1e-9);
    EXPECT_FALSE(scene->first_hit({{0, 0, 1.5}, {-1, 0, 0}}).any());
}

TEST(UrbanScene, EitherSideOfAWallBlocksAndIsMet) {
    const auto scene = built(one_wall());
    EXPECT_NEAR(scene->first_hit({{25, 3, 1.5}, {-1, 0, 0}}).distance, 15, 1e-9);
    EXPECT_TRUE(scene->blocked({{25, 3, 1.5}, {-1, 0, 0}}));
    EXPECT_TRUE(scene->blocked({{0, 3, 1.5}, {1, 0, 0}}));
}

TEST(UrbanScene, OnlyWhatIsWithinTheLengthBlocks) {
    const auto scene = built(one_wall());
    const SceneRay ray{{0, 0, 1.5}, {1, 0, 0}};
    EXPECT_TRUE(scene->blocked(ray, 10.1));
    EXPECT_FALSE(scene->blocked(ray, 9.9));
    EXPECT_FALSE(scene->blocked(ray, 0));
    EXPECT_FALSE(scene->blocked(ray, -5));
    EXPECT_TRUE(scene->blocked(ray, infinite));
}

class ClosedRoom : public ::testing::TestWithParam<double> {};

TEST_P(ClosedRoom, LetsNoRayOutAndHasItsWallsWhereTheyAre) {
    const Vector3d away = GetParam() * Vector3d(0.8, -0.6, 0);
    const Vector3d low = away + Vector3d(-20, -15, -1), high = away + Vector3d(25, 18, 30);
    CityModel city;
    add_box(city, low, high, 12);
    const auto scene = built(city);
    ASSERT_EQ(scene->planes().size(), 6U);
    const std::vector<SceneRay> rays = rays_from(away + Vector3d(1, 2, 1.5), 3, 100'000);
    std::vector<SceneHit> hits(rays.size());
    std::vector<std::uint8_t> blocked(rays.size());
    scene->first_hits(rays, hits, false);
    scene->blocked(rays, blocked);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const auto& [origin, direction] = rays[i];
        ASSERT_TRUE(hits[i].any()) << i;
        ASSERT_TRUE(blocked[i]) << i;
        ASSERT_TRUE(scene->first_hit(rays[i]).any()) << i;
        // The plane that was hit, in closed form from the corners of the room.
        int axis = 0;
        scene->planes()[hits[i].plane].normal.cwiseAbs().maxCoeff(&axis);
        const double wall = direction[axis] > 0 ? high[axis] : low[axis];
        ASSERT_NEAR(hits[i].distance, (wall - origin[axis]) / direction[axis], 1e-9) << i;
        // And it is the first one: no other is left behind but by the rounding of single precision.
        const Vector3d place = origin + hits[i].distance * direction;
        ASSERT_GT((place - low).minCoeff(), -2e-3) << i;
        ASSERT_GT((high - place).minCoeff(), -2e-3) << i;
    }
}

INSTANTIATE_TEST_SUITE_P(NearAndFar, ClosedRoom, ::testing::Values(0.0, 6'000.0));

TEST(UrbanScene, PacketsAnswerAsSingleRaysDo) {
    const auto scene = built(some_houses(400));
    const std::vector<SceneRay> rays = rays_from({100, 100, 1.5}, 500, 40'007);
    std::vector<std::uint8_t> blocked(rays.size());
    scene->blocked(rays, blocked);
    for (const bool coherent : {false, true}) {
        std::vector<SceneHit> hits(rays.size());
        scene->first_hits(rays, hits, coherent);
        int met = 0, apart = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const SceneHit single = scene->first_hit(rays[i]);
            met += single.any();
            // A ray into an edge may meet either facet.
            apart += single.any() != hits[i].any() || single.plane != hits[i].plane ||
                     single.distance != hits[i].distance || scene->blocked(rays[i]) != blocked[i] ||
                     blocked[i] != hits[i].any();
        }
        EXPECT_LE(apart, 4);
        EXPECT_GT(met, 20'000);
        EXPECT_LT(met, 39'000);
    }
}

TEST(UrbanScene, ShortPacketsLeaveTheRestAlone) {
    const auto scene = built(one_wall());
    const std::vector<SceneRay> rays(3, {{0, 0, 1.5}, {1, 0, 0}});
    std::vector<SceneHit> hits(4);
    std::vector<std::uint8_t> blocked(4, 7);
    scene->first_hits(rays, hits, true);
    scene->blocked(rays, blocked);
    EXPECT_EQ(blocked, (std::vector<std::uint8_t>{1, 1, 1, 7}));
    EXPECT_TRUE(hits[2].any());
    EXPECT_FALSE(hits[3].any());
    scene->first_hits({}, {}, false);
    scene->blocked(std::span<const SceneRay>{}, {});
}

TEST(UrbanScene, ThreadsThatShareItGetTheSameAnswers) {
    const auto scene = built(some_houses(100));
    const std::vector<SceneRay> rays = rays_from({50, 50, 1.5}, 100, 16'000);
    std::vector<std::vector<SceneHit>> hits(5, std::vector<SceneHit>(rays.size()));
    std::vector<std::thread> threads;
    for (auto& own : hits)
        threads.emplace_back([&] { scene->first_hits(rays, own, false); });
    for (std::thread& thread : threads)
        thread.join();
    for (const auto& own : hits)
        for (std::size_t i = 0; i < rays.size(); ++i) {
            ASSERT_EQ(own[i].triangle, hits[0][i].triangle);
            ASSERT_EQ(own[i].distance, hits[0][i].distance);
        }
}

TEST(UrbanScene, TheSameCityMakesTheSameScene) {
    const CityModel city = some_houses(100);
    const auto one = built(city), other = built(city);
    const std::vector<SceneRay> rays = rays_from({50, 50, 1.5}, 100, 16'000);
    std::vector<SceneHit> first(rays.size()), second(rays.size());
    one->first_hits(rays, first, false);
    other->first_hits(rays, second, false);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_EQ(first[i].triangle, second[i].triangle);
        ASSERT_EQ(first[i].distance, second[i].distance);
    }
    EXPECT_EQ(one->statistics().memory, other->statistics().memory);
}

TEST(UrbanScene, AFacetSeenEdgeOnIsMetOnlyWhereItIs) {
    // Rays in the plane of a wall, over it, beside it and into it, from either end.
    int met = 0, missed = 0;
    for (int turn = 0; turn < 360; turn += 3) {
        const double azimuth = turn * 3.14159265358979 / 180;
        const Vector3d along(std::sin(azimuth), std::cos(azimuth), 0), aside(along.y(), -along.x(), 0);
        const Vector3d corner = 30 * along + 7 * aside;
        CityModel city;
        city.add_triangle({corner, corner + 40 * along, corner + 40 * along + Vector3d(0, 0, 20)}, SurfaceKind::wall);
        const auto scene = built(city);
        for (int i = 0; i < 400; ++i) {
            const double offset = 1e-7 * (i % 20 - 10), rise = 0.002 * i;
            const SceneRay ray{7 * aside + offset * aside + Vector3d(0, 0, 0.5),
                               (along + Vector3d(0, 0, rise)).normalized()};
            const SceneHit hit = scene->first_hit(ray);
            ++(hit.any() ? met : missed);
            if (!hit.any()) continue;
            // At 70 m the ray is under the corner, and at a distance that the facet has.
            ASSERT_LT(0.5 + 70 * rise, 20.01) << turn << ' ' << i;
            ASSERT_GE(hit.distance, ray.direction.dot(corner - ray.origin) - 1e-9) << turn << ' ' << i;
            ASSERT_LE(hit.distance, ray.direction.dot(corner + 40 * along + Vector3d(0, 0, 20) - ray.origin) + 1e-9);
        }
    }
    EXPECT_GT(met, 100);
    EXPECT_GT(missed, 10'000);
}

TEST(UrbanScene, HeightsOfRoofsAndGround) {
    CityModel city = some_houses(0);
    // Its bottom below the ground: of two facets in one place either is met, by the processor that Embree finds.
    add_box(city, {10, 10, -1}, {20, 20, 12.5}, 1);
    const auto scene = built(city);
    EXPECT_NEAR(scene->top_at(15.3, 14.9).value(), 12.5, 1e-9);
    EXPECT_NEAR(scene->ground_at(15.3, 14.9).value(), 0, 1e-9);
    EXPECT_NEAR(scene->top_at(5, 5).value(), 0, 1e-9);
    EXPECT_FALSE(scene->top_at(-301, 5));
    EXPECT_FALSE(scene->ground_at(-301, 5));
    EXPECT_FALSE(built(one_wall())->ground_at(0, 0));
}

TEST(UrbanScene, SlopingGroundIsAsHighAsItIs) {
    CityModel city;
    city.add_quad({Vector3d(0, 0, 100), {200, 0, 120}, {200, 100, 120}, {0, 100, 100}}, SurfaceKind::ground);
    city.add_quad({Vector3d(0, 0, 90), {200, 0, 90}, {200, 100, 90}, {0, 100, 90}}, SurfaceKind::ground);
    const auto scene = built(city);
    EXPECT_NEAR(scene->ground_at(37, 50).value(), 103.7, 1e-9);
    EXPECT_NEAR(scene->top_at(150, 20).value(), 115, 1e-9);
}

TEST(UrbanScene, TheFootIsThatOfTheNearestHouseWhereNoGroundIs) {
    CityModel city;
    const auto wall = [&](double east, double low, double high) {
        city.add_quad({Vector3d(east, 0, low), {east, 9, low}, {east, 9, high}, {east, 0, high}}, SurfaceKind::wall);
    };
    wall(0, 503, 520);
    wall(20, 505, 507);
    wall(400, 460, 490);
    EXPECT_NEAR(built(city)->foot_at(25, 30), 503, 1e-9);
    EXPECT_NEAR(built(city)->foot_at(390, 5), 460, 1e-9);
    EXPECT_NEAR(built(city)->foot_at(9'000, 5), 460, 1e-9);
    city.add_quad({Vector3d(-90, -90, 499), {90, -90, 499}, {90, 90, 499}, {-90, 90, 499}}, SurfaceKind::ground);
    EXPECT_NEAR(built(city)->foot_at(25, 30), 499, 1e-9);
}

TEST(UrbanScene, SeesNoSkyInAHouseButUnderAnArchAndInAYard) {
    const auto slab = [](CityModel& city) {
        city.add_quad({Vector3d(-5, -5, 60), {5, -5, 60}, {5, 5, 60}, {-5, 5, 60}}, SurfaceKind::roof);
    };
    CityModel arch, yard;
    slab(arch);
    EXPECT_FALSE(sees_no_sky(*built(arch), {0, 0, 1.5}));
    for (const double side : {-5.0, 5.0}) {
        yard.add_quad({Vector3d(-5, side, 0), {5, side, 0}, {5, side, 60}, {-5, side, 60}}, SurfaceKind::wall);
        yard.add_quad({Vector3d(side, -5, 0), {side, 5, 0}, {side, 5, 60}, {side, -5, 60}}, SurfaceKind::wall);
    }
    EXPECT_FALSE(sees_no_sky(*built(yard), {0, 0, 1.5}));
    CityModel house = yard;
    slab(house);
    EXPECT_TRUE(sees_no_sky(*built(house), {0, 0, 1.5}));
    EXPECT_FALSE(sees_no_sky(*built(house), {20, 0, 1.5}));
}

TEST(UrbanScene, WoodsAloneAreAScene) {
    CityModel city;
    city.foliage.push_back({{{-700, -30}, {800, -30}, {800, 30}, {-700, 30}}, 8, 17, 5});
    const auto scene = built(city);
    EXPECT_EQ(scene->statistics().triangles, 0U);
    EXPECT_EQ(scene->statistics().lowest, Vector3d(-700, -30, 8));
    EXPECT_EQ(scene->statistics().highest, Vector3d(800, 30, 17));
    EXPECT_FALSE(scene->blocked({{0, 0, 5}, {0, 0, 1}}));
    EXPECT_FALSE(scene->ground_at(0, 0));
    EXPECT_EQ(scene->foot_at(0, 0), 5);
    EXPECT_EQ(scene->length_in_foliage({{0, 0, 5}, {0, 0, 1}}), 9);
    city.foliage.front().ring.clear();
    EXPECT_FALSE(UrbanScene::build(city)) << "nothing stands anywhere";
}

TEST(UrbanScene, WoodsWidenTheSceneAndDoNotLowerItsFoot) {
    CityModel city = one_wall();
    const double foot = built(city)->statistics().lowest.z();
    city.foliage.push_back({{{-9000, 0}, {-8000, 0}, {-8000, 30}}, foot - 6, foot + 90, foot - 9});
    EXPECT_EQ(built(city)->statistics().lowest.head<2>(),
              Eigen::Vector2d(-9000, built(one_wall())->statistics().lowest.y()));
    EXPECT_EQ(built(city)->statistics().lowest.z(), foot);
    EXPECT_EQ(built(city)->statistics().highest.z(), foot + 90);
}

TEST(UrbanScene, WhatLiesOnASurfaceIsPutJustAboveIt) {
    CityModel city;
    city.add_quad({Vector3d(-90, -90, 2), {90, -90, 2}, {90, 90, 2}, {-90, 90, 2}}, SurfaceKind::ground);
    city.add_quad({Vector3d(0, 0, 12), {9, 0, 12}, {9, 9, 12}, {0, 9, 12}}, SurfaceKind::roof);
    const auto scene = built(city);
    EXPECT_NEAR(scene->above_surface({-5, -5, 2}).z(), 2.005, 1e-9);
    EXPECT_NEAR(scene->above_surface({-5, -5, 1.96}).z(), 2.005, 1e-9);
    EXPECT_NEAR(scene->above_surface({4, 4, 12.001}).z(), 12.005, 1e-9);
    for (const Vector3d& place :
         {Vector3d(-5, -5, 1.9), Vector3d(-5, -5, 2.01), Vector3d(4, 4, 11), Vector3d(99, 0, 2)})
        EXPECT_EQ(scene->above_surface(place), place);
}

TEST(UrbanScene, CountsWhatItHolds) {
    CityModel city = some_houses(50);
    city.foliage.push_back({{{0, 0}, {1, 0}, {0, 1}}, 0, 5});
    city.origin = Geodetic::degrees(48.1, 11.6, 500);
    const auto scene = built(city);
    const SceneStatistics& counts = scene->statistics();
    EXPECT_EQ(counts.triangles, 602U);
    EXPECT_EQ(counts.triangles_of_kind, (std::array<std::size_t, 3>{400, 200, 2}));
    EXPECT_EQ(counts.planes, scene->planes().size());
    EXPECT_EQ(counts.degenerate + counts.not_finite, 0U);
    EXPECT_EQ(counts.lowest, Vector3d(-300, -300, -1));
    EXPECT_EQ(counts.highest.head<2>(), Eigen::Vector2d(1'100, 1'100));
    EXPECT_EQ(counts.sloped_share, 0);
    EXPECT_EQ(scene->foliage().size(), 1U);
    EXPECT_EQ(scene->materials(), city.materials);
    EXPECT_EQ(scene->frame().origin().latitude, city.origin.latitude);
    EXPECT_EQ(scene->triangle(3)[2], city.vertices[city.triangles[3].corners[2]]);
}

TEST(UrbanScene, MemoryIsCountedAndWithinTheEstimate) {
    const CityModel city = some_houses(3'000);
    const auto scene = built(city);
    const std::size_t triangles = scene->statistics().triangles;
    // Corners in double precision, corner numbers and planes alone, and the tree over them.
    EXPECT_GT(scene->statistics().memory, city.vertices.size() * sizeof(Vector3d) + 80 * triangles);
    EXPECT_LT(scene->statistics().memory, UrbanScene::estimated_memory(triangles));
}

TEST(UrbanScene, SlopedWallsAreKnownByTheirShare) {
    CityModel city = one_wall();
    const double lean = 30 * std::tan(0.2 * 3.14159265358979 / 180);
    city.add_quad({Vector3d(40, -50, 0), {40, 0, 0}, {40 + lean, 0, 30}, {40 + lean, -50, 30}}, SurfaceKind::wall);
    EXPECT_NEAR(built(city)->statistics().sloped_share, 1.0 / 3, 1e-5);
}

TEST(UrbanScene, TrianglesThatAreNoneAreLeftOutAndCounted) {
    CityModel city = one_wall();
    city.add_triangle({Vector3d(1, 1, 1), {2, 2, 2}, {4, 4, 4}}, SurfaceKind::wall);
    city.add_triangle({Vector3d(1, 1, 1), {1, 1, 1}, {4, 4, 4}}, SurfaceKind::wall);
    city.add_triangle({Vector3d(5, 5, 5), {5, 5, 5}, {5, 5, 5}}, SurfaceKind::wall);
    city.add_triangle({Vector3d(not_a_number, 1, 1), {2, 0, 2}, {4, 4, 4}}, SurfaceKind::wall);
    city.add_triangle({Vector3d(1, 1, 1), {2, infinite, 2}, {4, 4, 4}}, SurfaceKind::roof);
    city.add_triangle({Vector3d(1, 1, 1), {2, 0, -1e300}, {4, 4, 4}}, SurfaceKind::ground);
    city.add_quad({Vector3d(30, -50, 0), {30, 50, 0}, {30, 50, 30}, {30, -50, 30}}, SurfaceKind::wall);
    const auto scene = built(city);
    EXPECT_EQ(scene->statistics().degenerate, 3U);
    EXPECT_EQ(scene->statistics().not_finite, 3U);
    EXPECT_EQ(scene->statistics().triangles, 4U);
    EXPECT_EQ(scene->triangle(2)[0], Vector3d(30, -50, 0));
    EXPECT_NEAR(scene->first_hit({{20, 0, 5}, {1, 0, 0}}).distance, 10, 1e-9);
    EXPECT_EQ(scene->statistics().highest, Vector3d(30, 50, 30));
}

TEST(UrbanScene, ACityOfNothingIsRefused) {
    EXPECT_EQ(why_not(CityModel{}),
              "the city has no tree and no triangle to build on: 0 given, 0 without area, 0 with a corner that is no "
              "number or farther than 100,000 km");
    CityModel city;
    city.add_triangle({Vector3d(1, 1, 1), {2, 2, 2}, {4, 4, 4}}, SurfaceKind::wall);
    city.add_triangle({Vector3d(not_a_number, 1, 1), {2, 0, 2}, {4, 4, 4}}, SurfaceKind::wall);
    EXPECT_NE(why_not(city).find("2 given, 1 without area, 1 with"), std::string::npos);
}

TEST(UrbanScene, CornersAndMaterialsThatAreNotThereAreRefused) {
    CityModel city = one_wall();
    city.triangles[1].corners[2] = 4;
    EXPECT_EQ(why_not(city), "triangle 1 of the city has a corner 4, but there are 4");
    city = one_wall();
    city.triangles[0].material = 1;
    EXPECT_EQ(why_not(city), "triangle 0 of the city is of material 1, but there are 1");
}

TEST(UrbanScene, ACityThatTakesTooMuchMemoryIsRefusedWithTheEstimate) {
    const CityModel city = some_houses(200);
    const std::size_t estimate = UrbanScene::estimated_memory(city.triangles.size());
    EXPECT_EQ(why_not(city, {1e-3, 2'000'000}),
              "a city of 2402 triangles takes about 4 MB of memory, more than the 2 MB allowed");
    EXPECT_TRUE(UrbanScene::build(city, {1e-3, estimate}));
    EXPECT_FALSE(UrbanScene::build(city, {1e-3, estimate - 1}));
}

TEST(UrbanScene, RaysThatAreNoneMeetNothing) {
    const auto scene = built(some_houses(20));
    for (const Vector3d& bad : {Vector3d(not_a_number, 0, 1), Vector3d(0, 0, not_a_number)}) {
        EXPECT_FALSE(scene->first_hit({bad, {1, 0, 0}}).any());
        EXPECT_FALSE(scene->first_hit({{0, 0, 1}, bad}).any());
        EXPECT_FALSE(scene->blocked({bad, {1, 0, 0}}));
    }
    EXPECT_FALSE(scene->top_at(not_a_number, 0));
    EXPECT_FALSE(scene->ground_at(0, infinite));
}

}  // namespace
}  // namespace skyloop
