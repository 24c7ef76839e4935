#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <set>

#include "base/core/random.hpp"
#include "world/scene/urban_scene.hpp"

namespace skyloop {
namespace {

using Eigen::Vector3d;

/// A rectangle with sides `along` and `across`.
void add_facet(CityModel& city, const Vector3d& corner, const Vector3d& along, const Vector3d& across,
               SurfaceKind kind = SurfaceKind::wall) {
    city.add_quad({corner, corner + along, corner + along + across, corner + across}, kind);
}

std::shared_ptr<const UrbanScene> merged(const CityModel& city, double tolerance = 1e-3) {
    auto scene = UrbanScene::build(city, {tolerance, 0});
    EXPECT_TRUE(scene) << scene.error().message;
    return *scene;
}

double farthest_corner_from_its_plane(const UrbanScene& scene) {
    double farthest = 0;
    for (std::uint32_t i = 0; i < scene.statistics().triangles; ++i) {
        const ScenePlane& plane = scene.planes()[scene.plane_of(i)];
        for (const Vector3d& corner : scene.triangle(i))
            farthest = std::max(farthest, std::abs(plane.normal.dot(corner) - plane.offset));
    }
    return farthest;
}

TEST(PlaneMerge, ABoxHasSixPlanes) {
    CityModel city;
    const Vector3d low(10, 20, 0), x = Vector3d(8, 6, 0), y = Vector3d(-9, 12, 0), z = Vector3d(0, 0, 25);
    for (const auto& [corner, a, b] : {std::tuple(low, x, z),
                                       {low, y, z},
                                       {low, x, y},
                                       {Vector3d(low + x), y, z},
                                       {Vector3d(low + y), x, z},
                                       {Vector3d(low + z), x, y}})
        add_facet(city, corner, a, b);
    const auto scene = merged(city);
    EXPECT_EQ(scene->planes().size(), 6U);
    EXPECT_EQ(scene->statistics().planes, 6U);
    EXPECT_LE(farthest_corner_from_its_plane(*scene), 1e-12);
}

TEST(PlaneMerge, AKilometreOfOneWallIsOnePlane) {
    for (const double azimuth : {0.0, 0.3, 1.1, 2.0, 2.9}) {
        CityModel city;
        const Vector3d along(std::sin(azimuth), std::cos(azimuth), 0);
        const Vector3d start = Vector3d(4'000, -3'000, 20) - 500 * along;
        for (int i = 0; i < 100; ++i)
            for (int j = 0; j < 5; ++j)
                add_facet(city, start + 10.0 * i * along + Vector3d(0, 0, 3.0 * j), 10 * along, Vector3d(0, 0, 3));
        EXPECT_EQ(merged(city)->planes().size(), 1U) << azimuth;
    }
}

TEST(PlaneMerge, KindsAndMaterialsStayApart) {
    CityModel city;
    const std::uint8_t glass = city.material_index("glass");
    const Vector3d along(0, 10, 0), up(0, 0, 3);
    add_facet(city, {5, 0, 0}, along, up);
    city.add_quad({Vector3d(5, 0, 3), {5, 10, 3}, {5, 10, 6}, {5, 0, 6}}, SurfaceKind::wall, glass);
    add_facet(city, {5, 0, 6}, along, up, SurfaceKind::roof);
    add_facet(city, {5, 0, 9}, along, up);
    const auto scene = merged(city);
    ASSERT_EQ(scene->planes().size(), 3U);
    EXPECT_EQ(scene->planes()[1].material, glass);
    EXPECT_EQ(scene->planes()[2].kind, SurfaceKind::roof);
    EXPECT_EQ(scene->plane_of(7), scene->plane_of(0));
}

TEST(PlaneMerge, SidesDoNotMatter) {
    CityModel city;
    for (const double turn : {0.0, 0.7, 2.2}) {
        const Vector3d along(std::cos(turn), std::sin(turn), 0), up(0, 0, 4);
        add_facet(city, Vector3d(3, 50, 0), 10 * along, up);
        add_facet(city, Vector3d(3, 50, 4), 10 * along, up);
        std::swap(city.triangles.back().corners[0], city.triangles.back().corners[1]);
    }
    EXPECT_EQ(merged(city)->planes().size(), 3U);
}

TEST(PlaneMerge, TheToleranceIsAMillimetre) {
    for (const double away : {0.0, 6'000.0})
        for (const double azimuth : {0.0, 0.4, 2.7}) {
            const Vector3d along(std::sin(azimuth), std::cos(azimuth), 0), normal(along.y(), -along.x(), 0);
            for (const auto& [step, planes] : {std::pair(0.9e-3, 1U), {1.1e-3, 2U}, {-0.9e-3, 1U}, {-1.1e-3, 2U}}) {
                CityModel city;
                add_facet(city, away * along, 20 * along, Vector3d(0, 0, 10));
                add_facet(city, away * along + step * normal + Vector3d(0, 0, 12), 20 * along, Vector3d(0, 0, 9));
                EXPECT_EQ(merged(city)->planes().size(), planes) << away << ' ' << azimuth << ' ' << step;
            }
        }
}

TEST(PlaneMerge, AnotherToleranceIsObeyed) {
    CityModel city;
    add_facet(city, {0, 0, 0}, {0, 20, 0}, {0, 0, 10});
    add_facet(city, {0.02, 0, 12}, {0, 20, 0}, {0, 0, 9});
    EXPECT_EQ(merged(city, 0.03)->planes().size(), 1U);
    EXPECT_EQ(merged(city, 0.01)->planes().size(), 2U);
    EXPECT_EQ(merged(city, 0)->planes().size(), 2U);
}

TEST(PlaneMerge, NothingIsChained) {
    CityModel city;
    for (int i = 0; i < 200; ++i)
        add_facet(city, {0.4e-3 * i, 11.0 * i, 0}, {0, 10, 0}, {0, 0, 10});
    const auto scene = merged(city);
    EXPECT_LE(farthest_corner_from_its_plane(*scene), 1.001e-3);
    EXPECT_GE(scene->planes().size(), 40U);
    EXPECT_LE(scene->planes().size(), 100U);
}

TEST(PlaneMerge, RoundedCoordinatesStillMerge) {
    // As files have them that write millimetres; the side that normals are turned to is passed through as well.
    for (int turn = 0; turn < 360; ++turn) {
        const double azimuth = turn * 3.14159265358979 / 180 + 1e-4;
        const Vector3d along(std::sin(azimuth), std::cos(azimuth), 0);
        RandomStream random(static_cast<std::uint64_t>(turn), "rounding");
        CityModel city;
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j)
                add_facet(city, Vector3d(901, 1'203, 30) + 3.0 * i * along + Vector3d(0, 0, 3.0 * j), 3 * along,
                          Vector3d(0, 0, 3));
        for (Vector3d& vertex : city.vertices)
            vertex += 2e-4 * Vector3d(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
        const auto scene = merged(city);
        EXPECT_EQ(scene->planes().size(), 1U) << turn;
        EXPECT_EQ(scene->planes()[0].normal.z(), 0) << turn;
    }
}

TEST(PlaneMerge, NormalsOnTheBorderOfTheSidesMerge) {
    // At right angles to the direction by which sides are told; the smallest error turns the normal.
    const Vector3d along = Vector3d(0.6180, 0.7549, 0.2191).normalized();
    const Vector3d normal = along.unitOrthogonal(), across = along.cross(normal);
    RandomStream random(5, "border");
    CityModel city;
    for (int i = 0; i < 30; ++i)
        add_facet(city, 40 * normal + 2.0 * i * across, 3 * along, 1.9 * across);
    for (Vector3d& vertex : city.vertices)
        vertex += 1e-4 * Vector3d(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
    EXPECT_EQ(merged(city)->planes().size(), 1U);
}

TEST(PlaneMerge, UprightWallsAreExactlyUprightAndLeaningOnesAreNot) {
    CityModel city;
    add_facet(city, {5, 0, 0}, {0, 20, 0}, {4e-4, 0, 20});
    add_facet(city, {50, 0, 0}, {0, 20, 0}, {0.1, 0, 20});
    const auto scene = merged(city);
    ASSERT_EQ(scene->planes().size(), 2U);
    EXPECT_EQ(scene->planes()[0].normal.z(), 0);
    EXPECT_NEAR(std::abs(scene->planes()[1].normal.z()), 0.1 / std::hypot(0.1, 20), 1e-12);
    EXPECT_DOUBLE_EQ(scene->planes()[0].normal.norm(), 1);
    EXPECT_DOUBLE_EQ(scene->planes()[1].normal.norm(), 1);
}

TEST(PlaneMerge, ThePlaneIsThatOfTheLargestFacet) {
    CityModel city;
    add_facet(city, {5.0008, 0, 0}, {0, 1, 0}, {0, 0, 1});
    add_facet(city, {5, 0, 2}, {0, 40, 0}, {0, 0, 20});
    const auto scene = merged(city);
    ASSERT_EQ(scene->planes().size(), 1U);
    EXPECT_NEAR(std::abs(scene->planes()[0].offset), 5, 1e-12);
}

TEST(PlaneMerge, ManyLevelRoofsStayApart) {
    CityModel city;
    std::set<int> heights;
    RandomStream random(3, "roofs");
    for (int i = 0; i < 20'000; ++i) {
        const int millimetres = 6'000 + 4 * static_cast<int>(random.uniform() * 8'000);
        heights.insert(millimetres);
        add_facet(city, {20.0 * (i % 150), 20.0 * (i / 150), millimetres * 1e-3}, {15, 0, 0}, {0, 15, 0},
                  SurfaceKind::roof);
    }
    const auto scene = merged(city);
    EXPECT_EQ(scene->planes().size(), heights.size());
    EXPECT_LE(farthest_corner_from_its_plane(*scene), 1e-9);
}

TEST(PlaneMerge, SoupOfTrianglesLiesInItsPlanes) {
    RandomStream random(9, "soup");
    const auto anywhere = [&random] {
        return Vector3d(200 * random.uniform(), 200 * random.uniform(), 200 * random.uniform());
    };
    CityModel city;
    for (int i = 0; i < 3'000; ++i)
        city.add_triangle({anywhere(), anywhere(), anywhere()}, SurfaceKind::wall);
    // Each once more in four parts.
    for (std::size_t i = 0; i < 3'000; ++i) {
        const Vector3d a = city.vertices[3 * i], b = city.vertices[3 * i + 1], c = city.vertices[3 * i + 2];
        const Vector3d ab = (a + b) / 2, bc = (b + c) / 2, ca = (c + a) / 2;
        for (const auto& part : {std::array{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
            city.add_triangle(part, SurfaceKind::wall);
    }
    const auto scene = merged(city);
    EXPECT_LE(farthest_corner_from_its_plane(*scene), 1e-3);
    EXPECT_EQ(scene->planes().size(), 3'000U);
    for (std::uint32_t i = 0; i < 3'000; ++i)
        EXPECT_EQ(scene->plane_of(i), i);
}

}  // namespace
}  // namespace skyloop
